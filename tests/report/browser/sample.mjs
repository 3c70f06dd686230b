// A made-up flight in the page: what the C++ writes, without the C++. Used by browser_test.mjs, and by hand:
// `node sample.mjs /tmp/page.html [film]` writes one to look at.
import { spawnSync } from "node:child_process";
import { readFileSync, writeFileSync } from "node:fs";

const page = new URL("../../../scenarios/report/page/built/page.html", import.meta.url);
const types = { f32: Float32Array, u32: Uint32Array, u16: Uint16Array, u8: Uint8Array };

/// The same numbers on every run.
function make_random(seed) {
  return () => {
    seed = (Math.imul(seed, 1664525) + 1013904223) >>> 0;
    return seed / 2 ** 32;
  };
}

/// Puts facts, arrays [{name, type, components, values}] and other blocks {id: base64} into the page.
export function fill_page(facts, arrays, blocks = {}) {
  const parts = [];
  let offset = 0;
  facts.arrays = arrays.map(({ name, type, components, values }) => {
    const typed = types[type].from(values);
    const bytes = Buffer.alloc(Math.ceil(typed.byteLength / 4) * 4);
    Buffer.from(typed.buffer).copy(bytes);
    parts.push(bytes);
    const fact = { name, type, components, count: typed.length / components, offset };
    offset += bytes.length;
    return fact;
  });
  const json = JSON.stringify(facts).replaceAll("<", "\\u003c");
  const text = [
    `<script type="application/json" id="facts">${json}</script>`,
    `<script type="text/plain" id="arrays">${Buffer.concat(parts).toString("base64")}</script>`,
    ...Object.entries(blocks).map(([id, base64]) => `<script type="text/plain" id="${id}">${base64}</script>`),
  ].join("\n");
  return readFileSync(page, "utf8").replace("<!--DATA-->", () => text).replace("<title>Understory</title>", `<title>${facts.title}</title>`);
}

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
  const array = (name, type, components, values) => ({ name, type, components, values });
  const per_moment = (f) => times.map(f);
  const arrays = [
    array("t", "f32", 1, times), array("truth", "f32", 7, truth), array("estimate", "f32", 7, estimate),
    array("obstacles", "f32", 7, obstacles), array("elevons", "f32", 2, times.flatMap((t) => [0.2 * Math.sin(3 * t), -0.15 * Math.sin(3 * t)])),
    array("map_points", "f32", 3, map.flatMap((p) => p.slice(0, 3))), array("map_from", "f32", 1, map.map((p) => p[3])), array("map_to", "f32", 1, map.map((p) => p[4])),
    array("hits", "f32", 3, map.flatMap((p) => p.slice(0, 3))), array("hits_t", "f32", 1, map.map((p) => p[3])),
    array("plan_t", "f32", 1, plan_t), array("plan_start", "u32", 1, plan_start), array("plan_points", "f32", 3, plan_points),
    array("plan_origin", "u8", 1, plan_origin), array("plan_clearance", "f32", 1, plan_clearance),
    array("wing_vertices", "f32", 3, [0.135, 0, 0, -0.165, 0, 0, -0.045, 0.432, 0, -0.165, 0.432, 0, -0.045, -0.432, 0, -0.165, -0.432, 0, -0.17, 0.432, 0.16, -0.17, -0.432, 0.16, 0.02, 0, 0.035]),
    array("wing_triangles", "u16", 3, [0, 1, 2, 1, 3, 2, 0, 4, 1, 1, 4, 5, 2, 3, 6, 4, 7, 5, 0, 2, 8, 0, 8, 4, 2, 1, 8, 8, 1, 4]),
    array("wing_tips", "f32", 3, [-0.1, 0.432, 0, -0.1, -0.432, 0]),
    array("speed", "f32", 1, per_moment((t) => 12 + Math.sin(t))), array("speed_estimate", "f32", 1, per_moment((t) => 12.1 + Math.sin(t + 0.1))),
    array("altitude", "f32", 1, per_moment((t) => flown(t)[2])), array("altitude_estimate", "f32", 1, per_moment((t) => flown(t)[2] - 0.5 * drift(t))),
    array("clearance", "f32", 1, per_moment((t) => Math.max(0.02, 2.4 - 0.33 * t + 0.4 * Math.sin(4 * t)))),
    array("error", "f32", 1, per_moment((t) => drift(t))), array("error_high", "f32", 1, per_moment((t) => 0.1 + 0.2 * t)), array("error_low", "f32", 1, per_moment((t) => -0.1 - 0.2 * t)),
  ];
  const series = (name, array, color, more = {}) => ({ name, array, component: 0, color, ...more });
  const facts = {
    kind: "flight", title: "forest, seed 3", program: "understory 0.0.0 (sample)", ending: "collision",
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
    obstacles: { names: [...Array(trunks).keys()].map((i) => `tree_${i}`), kinds: Array(trunks).fill("trunk") },
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
      { t_s: 0.6, kind: "launch", text: "The catapult let go." }, { t_s: 6.1, kind: "in_view", text: "tree_17 came into view." },
      { t_s: 6.62, kind: "detected", text: "First hit on tree_17, at 6.2 m." }, { t_s: 6.86, kind: "fallback", text: "No free manoeuvre found: fallback." },
      { t_s: end_s, kind: "ending", text: "The outer left wing touched tree_17." },
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

if (process.argv[1] === import.meta.filename) {
  const [flight, blocks] = [sample_flight(), {}];
  if (process.argv[3] === "film") add_film(flight, blocks);
  writeFileSync(process.argv[2], fill_page(flight.facts, flight.arrays, blocks));
}
