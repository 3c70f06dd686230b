// Made-up flights, campaigns and sheets in the page: what the C++ writes, without the C++. Used by browser_test.mjs, and by hand:
// `node sample.mjs /tmp/page.html [film|campaign|sheet]` writes one to look at.
import { spawnSync } from "node:child_process";
import { readFileSync, writeFileSync } from "node:fs";

const page = new URL("../../../scenarios/report/page/built/page.html", import.meta.url);
const types = { f32: Float32Array, u32: Uint32Array, i16: Int16Array, u16: Uint16Array, u8: Uint8Array };

/// The same numbers on every run.
function make_random(seed) {
  return () => {
    seed = (Math.imul(seed, 1664525) + 1013904223) >>> 0;
    return seed / 2 ** 32;
  };
}

function pad(bytes) {
  return Buffer.concat([bytes, Buffer.alloc(-bytes.length & 3)]);
}

/// One buffer of the arrays [{name, type, components, values, scale}]; the facts get their table.
function pack_arrays(facts, arrays) {
  const parts = [];
  let offset = 0;
  facts.arrays = arrays.map(({ name, type, components, values, scale }) => {
    const stored = scale ? values.map((value) => (Number.isNaN(value) ? -32768 : Math.round(value / scale))) : values;
    const typed = types[type].from(stored);
    const bytes = pad(Buffer.from(typed.buffer));
    parts.push(bytes);
    const fact = { name, type, components, count: typed.length / components, offset, scale };
    offset += bytes.length;
    return fact;
  });
  return Buffer.concat(parts);
}

/// Puts facts, arrays and other blocks {id: base64} into the page.
export function fill_page(facts, arrays, blocks = {}) {
  const bytes = pack_arrays(facts, arrays);
  const json = JSON.stringify(facts).replaceAll("<", "\\u003c");
  const text = [
    `<script type="application/json" id="facts">${json}</script>`,
    `<script type="text/plain" id="arrays">${bytes.toString("base64")}</script>`,
    ...Object.entries(blocks).map(([id, base64]) => `<script type="text/plain" id="${id}">${base64}</script>`),
  ].join("\n");
  return readFileSync(page, "utf8").replace("<!--DATA-->", () => text).replace("<title>Understory</title>", `<title>${facts.title}</title>`);
}

const array = (name, type, components, values, scale) => ({ name, type, components, values, scale });

/// Position and quaternion at a moment: a weave that ends at the trunk, banked into its turns.
function flown(t) {
  const x = 11.5 * Math.max(t - 0.6, 0) + 1.2 * Math.min(t, 0.6);
  const y = 1.3 * Math.sin(0.9 * t) + 0.02 * t * t;
  const z = 2 + 0.9 * Math.sin(0.6 * t) + 0.05 * t;
  const bank = 0.8 * Math.sin(0.9 * t + 0.4);
  const [sx, cx] = [Math.sin(bank / 2), Math.cos(bank / 2)];
  const [sz, cz] = [Math.sin(0.05 * Math.cos(0.9 * t)), Math.cos(0.05 * Math.cos(0.9 * t))];
  return [x, y, z, cz * sx, sz * sx, sz * cx, cz * cx];
}

/// The facts and arrays of a lost flight. trunks: how many obstacles.
export function sample_flight({ trunks = 150, end_s = 7.31 } = {}) {
  const random = make_random(7);
  const times = [];
  for (let i = 0; i / 120 <= end_s; ++i) times.push(i / 120);
  times.push(end_s);
  const drift = (t) => 0.015 * t * t;
  const truth = times.flatMap(flown);
  const estimate = times.flatMap((t) => { const p = flown(t); p[1] += drift(t); p[2] -= 0.5 * drift(t); return p; });
  const [x1, y1, z1] = flown(end_s);

  const obstacles = [];
  for (let i = 0; i < trunks; ++i) {
    const [x, radius, height] = [8 + 85 * random(), 0.06 + 0.16 * random(), 6 + 5 * random()];
    const side = random() < 0.5 ? -1 : 1;
    const y = side * (1.8 + 12 * random());
    obstacles.push(x, y, 0, x + 0.3 * (random() - 0.5), y + 0.4 * (random() - 0.5), height, radius);
  }
  const touched = Math.min(17, trunks - 1);
  if (touched >= 0) obstacles.splice(touched * 7, 7, x1 + 0.1, y1 + 0.42, 0, x1 + 0.1, y1 + 0.42, 8, 0.14);

  const map = [];
  for (let i = 0; i < trunks; ++i) {
    const x = obstacles[i * 7];
    const from = times.find((t) => flown(t)[0] > x - 10);
    if (from === undefined) continue;
    for (let k = 0; k < 12; ++k) map.push([x + 0.2 * random(), obstacles[i * 7 + 1] + drift(from) + 0.2 * random(), 0.5 + 4 * random(), from + 0.5 * random(), from + 1.5 + random()]);
  }
  map.sort((a, b) => a[3] - b[3]);
  const plan_t = [], plan_start = [], plan_points = [], plan_origin = [], plan_clearance = [];
  for (let t = 0.6; t < end_s; t += 0.1) {
    plan_t.push(t);
    plan_start.push(plan_points.length / 3);
    for (let k = 0; k <= 30; ++k) plan_points.push(...flown(t + k * 0.04).slice(0, 3));
    plan_origin.push(t > end_s - 0.45 ? 3 : Math.floor(random() * 3));
    plan_clearance.push(t < 2 ? NaN : 0.3 + random());
  }
  const per_moment = (f) => times.map(f);
  const arrays = [
    array("t", "f32", 1, times), array("truth", "f32", 7, truth), array("estimate", "f32", 7, estimate),
    array("obstacles", "f32", 7, obstacles), array("elevons", "i16", 2, times.flatMap((t) => (t < 0.6 ? [NaN, NaN] : [0.2 * Math.sin(3 * t), -0.15 * Math.sin(3 * t)])), 1e-4),
    array("map_points", "f32", 3, map.flatMap((p) => p.slice(0, 3))), array("map_from", "f32", 1, map.map((p) => p[3])), array("map_to", "f32", 1, map.map((p) => p[4])),
    array("hits", "f32", 3, map.flatMap((p) => p.slice(0, 3))), array("hits_t", "f32", 1, map.map((p) => p[3])),
    array("plan_t", "f32", 1, plan_t), array("plan_start", "u32", 1, plan_start), array("plan_points", "f32", 3, plan_points),
    array("plan_origin", "u8", 1, plan_origin), array("plan_clearance", "f32", 1, plan_clearance),
    array("wing_vertices", "f32", 3, [0.135, 0, 0, -0.165, 0, 0, -0.045, 0.432, 0, -0.165, 0.432, 0, -0.045, -0.432, 0, -0.165, -0.432, 0, -0.17, 0.432, 0.16, -0.17, -0.432, 0.16, 0.02, 0, 0.035]),
    array("wing_triangles", "u16", 3, [0, 1, 2, 1, 3, 2, 0, 4, 1, 1, 4, 5, 2, 3, 6, 4, 7, 5, 0, 2, 8, 0, 8, 4, 2, 1, 8, 8, 1, 4]),
    array("wing_tips", "f32", 3, [-0.1, 0.432, 0, -0.1, -0.432, 0]),
    array("touched_box", "f32", 3, [-0.1, 0.33, 0, 0.07, 0.1, 0.02]),
    array("speed", "f32", 1, per_moment((t) => 12 + Math.sin(t))), array("speed_estimate", "f32", 1, per_moment((t) => 12.1 + Math.sin(t + 0.1))),
    array("altitude", "f32", 1, per_moment((t) => flown(t)[2])), array("altitude_estimate", "f32", 1, per_moment((t) => flown(t)[2] - 0.5 * drift(t))),
    array("clearance", "f32", 1, per_moment((t) => Math.max(0.02, 2.4 - 0.33 * t + 0.4 * Math.sin(4 * t)))),
    array("error", "f32", 1, per_moment((t) => drift(t))), array("error_high", "f32", 1, per_moment((t) => 0.1 + 0.2 * t)), array("error_low", "f32", 1, per_moment((t) => -0.1 - 0.2 * t)),
  ];
  const series = (name, array, color, more = {}) => ({ name, array, component: 0, color, ...more });
  const facts = {
    kind: "flight", title: "forest, seed 3", program: "understory 0.0.0 (sample)", outcome: "collision",
    sentence: "The outer left wing touched tree_17 at 7.31 s, 77.9 m from the launch, 3.1 m high.",
    warning: "", story: [
      "tree_17 came into view 1.2 s before the end, at 14 m; the first hit on it followed 0.5 s later, at 6.2 m.",
      "The last five plans were fallbacks: no manoeuvre kept the wanted clearance.",
      "The estimate of the position was 0.8 m beside the truth.",
    ],
    command: "understory fly forest --seed 3 --set planning.horizon_s=1.2", scenario: "course: forest\nseed: 3\n", digest: "0x1234abcd5678ef90",
    result: [["flight time", "7.31 s"], ["distance", "77.9 m"], ["smallest clearance", "0.00 m"], ["replans", "67"], ["of these fallbacks", "5"]],
    keys: [["planning.horizon_s", "1.5", "1.2"], ["camera.rate_hz", "120", "60"]],
    t_end_s: end_s, t_launch_s: 0.6,
    course: { goal_x_m: 95, half_width_m: 15, minimum_altitude_m: 0.5, maximum_altitude_m: 8, cruise_altitude_m: 2.5 },
    touched_name: touched >= 0 ? `tree_${touched}` : undefined,
    touched: touched >= 0 ? touched : null, impact: { position: [x1 + 0.02, y1 + 0.3, z1], part: "left_wing_outer" },
    camera: { width_px: 376, height_px: 240, fx: 210, fy: 210, cx: 188, cy: 120, T_body_camera: [0, 0.19, 0.98, 0.1, -1, 0, 0, 0.17, 0, -0.98, 0.19, 0, 0, 0, 0, 1], depths_m: [5, 10], baseline_m: 0.34 },
    charts: [
      { title: "Clearance", unit: "m", series: [series("to the nearest obstacle", "clearance", "truth"), series("of the plan", "plan_clearance", "command", { time: "plan_t" })], bands: [], limits: [{ name: "wanted", value: 0.5 }], words: null },
      { title: "Plans", unit: "", series: [series("origin", "plan_origin", "command", { time: "plan_t" })], bands: [], limits: [], words: ["straight", "solved", "kept", "fallback"] },
      { title: "Altitude", unit: "m", series: [series("truth", "altitude", "truth"), series("estimate", "altitude_estimate", "estimate")], bands: [], limits: [{ name: "lowest", value: 0.5 }, { name: "highest", value: 8 }], words: null },
      { title: "Airspeed", unit: "m/s", series: [series("truth", "speed", "truth"), series("estimate", "speed_estimate", "estimate")], bands: [], limits: [], words: null },
      { title: "Error of the position across", unit: "m", series: [series("error", "error", "estimate")], bands: [{ name: "3 sigma", lower: "error_low", upper: "error_high" }], limits: [], words: null },
      { title: "Elevons", unit: "rad", series: [series("left", "elevons", "truth"), series("right", "elevons", "other", { component: 1 })], bands: [], limits: [], words: null },
    ],
    events: [
      { t_s: 0.6, kind: "launch", text: "The catapult let go." }, { t_s: end_s - 1.21, kind: "in_view", text: "tree_17 came into view." },
      { t_s: end_s - 0.69, kind: "detected", text: "First hit on tree_17, at 6.2 m." }, { t_s: end_s - 0.45, kind: "fallback", text: "No free manoeuvre found: fallback." },
      { t_s: end_s, kind: "outcome", text: "The outer left wing touched tree_17." },
    ],
    decimation: ["moments: all of them"], film: null,
  };
  return { facts, arrays };
}

/// A film of the flight, 20 pictures a second, and a still; false where ffmpeg is missing.
export function add_film({ facts, arrays }, blocks) {
  const encode = (...options) => spawnSync("ffmpeg", ["-v", "error", "-f", "lavfi", "-i", "testsrc=size=376x240:rate=20", ...options, "-"], { maxBuffer: 1e8 });
  const film = encode("-t", String(facts.t_end_s), "-pix_fmt", "yuv420p", "-g", "10", "-f", "mp4", "-movflags", "frag_keyframe+empty_moov");
  if (film.error || film.status !== 0) return false;
  blocks.film = film.stdout.toString("base64");
  blocks.still = encode("-frames:v", "1", "-vf", "negate", "-f", "mjpeg").stdout.toString("base64");
  const values = Array.from({ length: Math.ceil(facts.t_end_s * 20) }, (_, i) => i / 20);
  arrays.push({ name: "film_t", type: "f32", components: 1, values });
  facts.film = { times: "film_t" };
  return true;
}

/// The share of `goals` of `flown` and its 95 % interval (Wilson).
function share_of(goals, flown) {
  if (flown === 0) return { share: null, lower: null, upper: null };
  const [p, z2] = [goals / flown, 1.96 ** 2];
  const half = Math.sqrt((p * (1 - p)) / flown + z2 / (4 * flown * flown)) * 1.96;
  return { share: p, lower: (p + z2 / (2 * flown) - half) / (1 + z2 / flown), upper: (p + z2 / (2 * flown) + half) / (1 + z2 / flown) };
}

/// Packs a flight into a block as the C++ does.
function pack_track({ facts, arrays }) {
  const { scenario, result, keys, decimation, ...kept } = facts;
  kept.charts = kept.charts.slice(0, 3);
  const bytes = pack_arrays(kept, arrays);
  const json = Buffer.from(JSON.stringify(kept));
  const length = Buffer.alloc(4);
  length.writeUInt32LE(json.length);
  return Buffer.concat([pad(Buffer.concat([length, json])), bytes]).toString("base64");
}

/// A campaign of 2 x 2 conditions. seeds: flights of each; tracks: how many lost ones can be replayed.
export function sample_campaign({ seeds = 50, tracks = 20, gate = true } = {}) {
  const random = make_random(11);
  const [speed_key, trees_key] = ["autopilot.flight_model.cruise_speed_mps", "forest.square_metres_per_tree"];
  const outcomes = ["goal", "collision", "ground", "out_of_bounds", "time", "not_flown"];
  const conditions = [], flights = [], arrays = [], survival = [];
  for (const [speed, trees, chance] of [["8", "49", 0.97], ["8", "20", 0.85], ["12", "49", 0.9], ["12", "20", 0.55]]) {
    const own = [];
    for (let seed = 1; seed <= seeds; ++seed) {
      const outcome = random() < 0.01 ? 5 : random() < chance ? 0 : [1, 1, 1, 2, 3, 4][Math.floor(random() * 6)];
      const progress = outcome === 5 ? NaN : outcome === 0 ? 75 : 5 + 68 * random();
      own.push({ condition: conditions.length, seed, outcome, progress, time: progress / Number(speed), clearance: outcome === 1 ? 0 : 0.1 + random() });
    }
    flights.push(...own);
    const flown = own.filter((each) => each.outcome !== 5);
    const goals = own.filter((each) => each.outcome === 0).length;
    const steps = [[0, 0]];
    for (const { progress } of flown.filter((each) => each.outcome !== 0).sort((a, b) => a.progress - b.progress)) steps.push([progress, steps.length]);
    steps.push([75, steps.length - 1]);
    arrays.push(array(`survival_${conditions.length}`, "f32", 4, steps.flatMap(([distance, lost]) => {
      const { share, lower, upper } = share_of(flown.length - lost, flown.length);
      return [distance, share, lower, upper];
    })));
    survival.push({ condition: conditions.length, array: `survival_${conditions.length}` });
    conditions.push({ name: `v${speed}_t${trees}`, label: `${speed} m/s, ${trees} m² per tree`, keys: { [speed_key]: speed, [trees_key]: trees }, flights: seeds, flown: flown.length, goals, ...share_of(goals, flown.length) });
  }
  const column = (name, values) => array(`column_${name}`, "f32", 1, values);
  arrays.push(array("row_condition", "u16", 1, flights.map((each) => each.condition)), array("row_outcome", "u8", 1, flights.map((each) => each.outcome)),
    column("progress_m", flights.map((each) => each.progress)), column("time_s", flights.map((each) => each.time)), column("clearance_m", flights.map((each) => each.clearance)));
  const id = ({ condition, seed }) => `${conditions[condition].name}/seed-${seed}`;
  const lost = [...flights.keys()].filter((row) => flights[row].outcome >= 1 && flights[row].outcome <= 4).slice(0, tracks);
  const blocks = {};
  for (const row of lost) {
    const flight = sample_flight({ trunks: 60, end_s: 3 + (row % 5) });
    flight.facts.title = id(flights[row]);
    flight.facts.command = "";
    blocks[`track-${row}`] = pack_track(flight);
  }
  const [goals, flown] = ["goals", "flown"].map((name) => conditions.reduce((sum, each) => sum + each[name], 0));
  const reasons = ["", "touched a tree", "flew into the ground", "left the course", "the time was over", "no room for the launch"];
  const facts = {
    kind: "campaign", title: "gate", program: "understory 0.0.0 (sample)", warning: "", sentence: `${goals} of ${flown} flights reached the goal.`,
    conditions, grid_keys: [speed_key, trees_key], outcomes, survival,
    columns: [{ name: "progress_m", label: "progress", unit: "m" }, { name: "time_s", label: "time", unit: "s" }, { name: "clearance_m", label: "smallest clearance", unit: "m" }],
    rows: {
      ids: flights.map(id), seeds: flights.map((each) => String(each.seed)), reasons: flights.map((each) => reasons[each.outcome]),
      touched: flights.map((each, row) => (each.outcome === 1 ? `tree_${String((row * 37) % 150).padStart(4, "0")}` : "")),
      commands: flights.map((each) => `understory fly forest --seed ${each.seed} --set ${speed_key}=${conditions[each.condition].keys[speed_key]}`),
    },
    tracks: Object.fromEntries(lost.map((row) => [row, `track-${row}`])),
    gate: gate ? {
      verdict: "fails", title: "The gate says of this version against version 0.1: worse", baseline: "version 0.1", candidate: "this version", lines: ["worse: all: success fell by 4.0 percentage points, from 168 to 160 of 200. A net loss of 7 of these pairs (3.5 points) would be called worse."],
      pairs: flights.map((each) => [conditions[each.condition].label, each.seed, outcomes[random() < 0.95 ? each.outcome : 0], outcomes[each.outcome]]),
    } : null,
  };
  return { facts, arrays, blocks };
}

/// A sheet with every kind of section.
export function sample_sheet() {
  const random = make_random(5);
  const x = Array.from({ length: 40 }, (_, i) => i * 2.5);
  const rows = ["rms_m", "bias_m"].map((_, k) => x.map((value) => (0.002 + 0.001 * k) * value * value * (0.9 + 0.2 * random())));
  const arrays = [array("x", "f32", 1, x), array("rms_m", "f32", 1, rows[0]), array("bias_m", "f32", 1, rows[1].map((y, i) => (i === 7 ? NaN : y))),
    array("low", "f32", 1, rows[0].map((y) => 0.8 * y)), array("high", "f32", 1, rows[0].map((y) => 1.2 * y)),
    array("trial", "f32", 1, [1, 2, 3, 4, 5, 6]), array("score", "f32", 1, [0.5, 0.61, 0.58, 0.72, 0.71, 0.8]), array("score_low", "f32", 1, [0.4, 0.5, 0.5, 0.6, 0.6, 0.7]), array("score_high", "f32", 1, [0.6, 0.7, 0.68, 0.8, 0.8, 0.9])];
  const facts = {
    kind: "sheet", title: "stereo accuracy", program: "understory 0.0.0 (sample)", warning: "Made-up numbers.", sentence: "The depth is wrong by 4 % at 20 m.",
    sections: [
      { title: "Error over distance", text: "Over all pixels of the left image that have a match.", table: null, pictures: [],
        plot: { x_label: "distance, m", y_label: "error, m", series: [{ name: "root mean square", x: "x", y: "rms_m", lower: "low", upper: "high", mark: "line" }, { name: "bias", x: "x", y: "bias_m", mark: "steps" }] } },
      { title: "Trials", text: "", pictures: [],
        plot: { x_label: "trial", y_label: "share of goals", x_names: [[1, "first"], [6, "last"]], series: [{ name: "trials", x: "trial", y: "score", lower: "score_low", upper: "score_high", mark: "points", labels: [1, 2, 3, 4, 5, 6].map((i) => `horizon ${i} s`) }] },
        table: { columns: [{ label: "trial", unit: "" }, { label: "horizon", unit: "s" }, { label: "share", unit: "" }, { label: "verdict" }], rows: [[1, 1, 0.5, "worse"], [2, 2, 0.61, "same"], [10, 3, null, "broken off"]] } },
      { title: "Pictures", text: "", plot: null, table: null, pictures: [{ caption: "One grey pixel", block: "picture-0", type: "image/png" }, { caption: "Lost", block: "picture-9", type: "image/png" }] },
    ],
  };
  const pixel = "iVBORw0KGgoAAAANSUhEUgAAAAEAAAABCAAAAAA6fptVAAAACklEQVR4nGNoAAAAggCBd81ytgAAAABJRU5ErkJggg==";
  return { facts, arrays, blocks: { "picture-0": pixel } };
}

if (process.argv[1] === import.meta.filename) {
  const [file, kind] = process.argv.slice(2);
  const page = kind === "campaign" ? sample_campaign() : kind === "sheet" ? sample_sheet() : { ...sample_flight(), blocks: {} };
  if (kind === "film") add_film(page, page.blocks);
  writeFileSync(file, fill_page(page.facts, page.arrays, page.blocks));
}
