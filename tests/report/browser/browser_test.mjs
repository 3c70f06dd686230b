// The page of a flight in a real browser that draws in software. Arguments: `contents` or `speeds`, then pages made by
// `understory`; they go through the same checks as the made-up flight. Exit status 77 where the browser or a library
// is missing.
import { readFileSync } from "node:fs";
import { basename, dirname, resolve } from "node:path";
import { check, close, end, failures, open, write } from "./browser.mjs";
import { check_campaign, check_given_campaign, check_large_campaign, check_sheet } from "./campaign_checks.mjs";
import { add_film, sample_flight } from "./sample.mjs";

/// What a page holds, decoded here once more: the reference of the checks.
function read_page(file) {
  const text = readFileSync(file, "utf8");
  const block = (id) => text.split(new RegExp(`<script[^>]*id="${id}">`))[1].split("</script>")[0];
  const facts = JSON.parse(block("facts"));
  const bytes = Buffer.from(block("arrays"), "base64");
  const floats = (name, tuple) => {
    const array = facts.arrays.find((each) => each.name === name);
    return Array.from({ length: array.components }, (_, i) => bytes.readFloatLE(array.offset + 4 * (array.components * tuple + i)));
  };
  return { facts, floats, moments: facts.arrays.find((each) => each.name === "t")?.count };
}

const far_apart = (a, b) => Math.max(...[0, 1, 2].map((i) => Math.abs(a[i] - b[i])));

async function check_speed(file, name) {
  const opens_s = [];
  for (let i = 0; i < 2; ++i) { // the best of two: other jobs may be running
    const opened = await open(file);
    opens_s.push(opened.open_s);
    await opened.page.close();
  }
  console.log(`       ${name}: opens in ${opens_s.map((s) => `${s.toFixed(2)} s`).join(", ")}`);
  const opened = await open(file, { width: 1300, height: 800 });
  const { page } = opened;
  await page.addStyleTag({ content: ".replay { position: fixed !important; inset: 0 auto auto 0; width: 1280px; height: 720px; z-index: 9; }" });
  await opened.settle();
  await page.evaluate(() => understory.seek(1e9));
  for (const view of ["follow", "fit"]) {
    await page.evaluate((view) => understory.view(view), view);
    await opened.settle();
    const [seconds, triangles] = await page.evaluate(() => [Math.min(...[1, 2, 3].map(() => understory.draw_seconds(4))), understory.triangles()]);
    console.log(`       ${name}: ${(1 / seconds).toFixed(0)} pictures/s at 1280x720, ${view}`);
    check(`${name}: at most 50,000 triangles, ${view}`, triangles > 0 && triangles <= 50000, triangles);
  }
  await close(opened, `${name}, large`);
}

async function check_flight(file, name) {
  const opened = await open(file);
  const { page, settle } = opened;
  const { facts, floats, moments } = read_page(file);
  const at_s = () => page.evaluate(() => understory.time());
  const start_s = await at_s();
  const triangles = await page.evaluate(() => understory.triangles());
  check(`${name}: at most 50,000 triangles`, triangles <= 50000, triangles);
  const end_s = await page.evaluate(() => Number(document.querySelector(".scrub input").max));
  const expected_s = facts.outcome === "goal" ? null : Math.max(end_s - 1, 0);
  check(`${name}: paused, a lost flight 1 s before its end`, !(await page.evaluate(() => understory.playing())) && (expected_s === null || Math.abs(start_s - expected_s) < 0.01), start_s);
  check(`${name}: says how it ended`, (await page.evaluate(() => document.body.innerText)).includes(facts.sentence));

  // The aircraft is where project() puts it, and was not there a moment before: so it is not the background.
  await page.evaluate(() => document.querySelectorAll(".layers [aria-pressed=true]").forEach((button) => button.click()));
  for (const moment of [Math.floor(0.4 * moments), moments - 1]) {
    const time_s = floats("t", moment)[0];
    const [there, before] = await page.evaluate((time_s, position) => {
      understory.seek(time_s);
      understory.view("follow");
      understory.project(...position); // draws, so that the orbit begins behind the aircraft
      understory.view("orbit");
      const at = understory.project(...position);
      const there = understory.pixel(...at);
      understory.seek(time_s - 0.6);
      understory.project(...position);
      return [there, understory.pixel(...at)];
    }, time_s, floats("truth", moment).slice(0, 3));
    check(`${name}: the aircraft is where it was at ${time_s.toFixed(2)} s`, far_apart(there, before) > 24, `${there} instead of ${before}`);
  }
  if (facts.touched != null) {
    const alike = await page.evaluate((from, to) => {
      understory.seek(1e9);
      understory.view("follow");
      understory.project(0, 0, 0);
      understory.view("orbit");
      const hex = getComputedStyle(document.documentElement).getPropertyValue("--alert").trim();
      const alert = [1, 3, 5].map((i) => parseInt(hex.slice(i, i + 2), 16));
      let alike = 0;
      for (let i = 1; i < 40; ++i) { // along its axis: the surface in front of it is shaded, its hue is not
        const at = understory.project(...from.map((value, axis) => value + (i / 40) * (to[axis] - value)));
        const color = at && understory.pixel(...at);
        const light = color && color[0] / alert[0];
        if (light > 0.4 && light < 1.1 && Math.max(...[1, 2].map((k) => Math.abs(color[k] - light * alert[k]))) < 12) ++alike;
      }
      return alike;
    }, floats("obstacles", facts.touched).slice(0, 3), floats("obstacles", facts.touched).slice(3, 6));
    check(`${name}: what it touched has the alert colour`, alike > 3, `${alike} of 39 places`);
  }
  await check_hands(opened, name, end_s);
  await close(opened, name);
}

async function check_hands({ page, settle }, name, end_s) {
  await page.evaluate(() => { // no download folder in a test
    HTMLAnchorElement.prototype.click = function () { window.downloaded = this.download; };
  });
  const buttons = await page.$$("button:not(dialog button)");
  let unnamed = 0;
  for (const button of buttons) {
    if (!(await button.isVisible())) continue;
    if (!(await button.evaluate((b) => b.ariaLabel || b.textContent.trim()))) ++unnamed;
    await button.click();
    await page.evaluate(() => document.querySelector("dialog").close());
  }
  await settle();
  check(`${name}: all ${buttons.length} buttons work and have names`, unnamed === 0, unnamed || "");
  const film_px = () => page.$eval(".film", (film) => (film.hidden ? 0 : film.getBoundingClientRect().width));
  const large_px = await film_px();
  await page.keyboard.press("v");
  await settle();
  const small_px = await film_px();
  check(`${name}: v makes the film small again`, large_px === 0 || large_px > 1.5 * small_px, `${large_px}, ${small_px}`);
  const at_s = () => page.evaluate(() => understory.time());
  await page.evaluate(() => (understory.pause(), document.activeElement.blur()));
  const press = async (...keys) => {
    for (const key of keys) await page.keyboard.press(key);
    await settle();
  };
  const near = (a, b) => Math.abs(a - b) < 1e-3;
  await press("End");
  check(`${name}: End`, near(await at_s(), end_s));
  if (end_s > 1) {
    await press("ArrowLeft");
    check(`${name}: arrow goes one moment back`, near(await at_s(), end_s - 1 / 120));
    await page.keyboard.down("Shift");
    await press("ArrowLeft");
    await page.keyboard.up("Shift");
    check(`${name}: shift arrow goes 0.1 s back`, near(await at_s(), end_s - 1 / 120 - 0.1));
    await press("Home", " ");
    await page.waitForFunction("understory.time() > 0");
    await press(" ");
    const stopped_s = await at_s();
    await new Promise((done) => setTimeout(done, 100));
    check(`${name}: space plays and pauses`, stopped_s > 0 && near(stopped_s, await at_s()), stopped_s);
    const chart = await page.$(".chart .u-over");
    if (chart) {
      await page.click('[data-action="whole"]');
      await chart.scrollIntoView();
      const box = await chart.boundingBox();
      await page.mouse.click(box.x + box.width / 2, box.y + box.height / 2);
      await settle();
      check(`${name}: a click on a chart seeks`, Math.abs((await at_s()) - end_s / 2) < 0.05 * end_s, await at_s());
    }
  }
  const theme = () => page.evaluate(() => document.documentElement.dataset.theme);
  const before = await theme();
  await press("t");
  check(`${name}: both themes`, (await theme()) !== before);
  await press("1", "2", "3", "4", "0", "e", "m", "h", "p", "f", "+", "-", "?", "?");
  const canvas = await (await page.$(".replay canvas"))?.boundingBox();
  if (!canvas) return;
  await press("2");
  const [x, y] = [canvas.x + canvas.width / 2, canvas.y + canvas.height / 2];
  const corner = () => page.evaluate(() => JSON.stringify(understory.project(5, 0, 0)));
  const still = await corner();
  await page.mouse.move(x, y);
  await page.mouse.down();
  await page.mouse.move(x + 60, y + 20);
  await page.mouse.up();
  await settle();
  const turned = await corner();
  await page.mouse.wheel({ deltaY: 200 });
  await settle();
  check(`${name}: drag turns, wheel zooms`, still !== turned && turned !== (await corner()));
}

async function check_phone(file, name) {
  for (const [width, height, theme] of [[390, 844, "light"], [1280, 720, "light"], [1920, 1080, "dark"]]) {
    const opened = await open(file, { width, height, theme });
    const wide = await opened.page.evaluate(() => document.documentElement.scrollWidth);
    check(`${name}: no sideways scrolling at ${width} px`, wide <= width, wide);
    check(`${name}: begins ${theme}`, (await opened.page.evaluate(() => document.documentElement.dataset.theme)) === theme);
    await close(opened, `${name} at ${width} px`);
  }
}

async function check_film(flight) {
  const blocks = {};
  if (!add_film(flight, blocks)) return console.log("no film checked: ffmpeg is missing");
  const opened = await open(write("film", flight.facts, flight.arrays, blocks));
  const { page, settle } = opened;
  await page.waitForFunction(() => document.querySelector("video").readyState >= 2);
  for (const time_s of [5, 2.02]) {
    await page.evaluate((time_s) => understory.seek(time_s), time_s);
    await settle();
    await page.waitForFunction(() => !document.querySelector("video").seeking);
    const film_s = await page.evaluate(() => document.querySelector("video").currentTime);
    check(`film: in step at ${time_s} s`, Math.abs(film_s - time_s - 0.025) < 0.05, film_s);
  }
  await page.evaluate(() => understory.seek(1e9));
  await settle();
  check("film: the still stands at the end", await page.evaluate(() => document.querySelector("video").hidden && document.querySelector(".film img").naturalWidth === 376));
  await close(opened, "film");
}

/// The estimate is 3 m beside the truth, and the map holds one point that was truly at a known place.
async function check_memory() {
  const flight = sample_flight();
  const by_name = (name) => flight.arrays.find((array) => array.name === name);
  by_name("estimate").values = by_name("truth").values.map((value, i) => (i % 7 === 1 ? value + 3 : value));
  const moment = 600;
  const [x, y, z] = by_name("truth").values.slice(moment * 7, moment * 7 + 3);
  const place = [x + 1.5, y, z + 0.3];
  by_name("map_points").values = [place[0], place[1] + 3, place[2]];
  by_name("map_from").values = [1];
  by_name("map_to").values = [flight.facts.t_end_s];
  const opened = await open(write("memory", flight.facts, flight.arrays));
  const [color, expected] = await opened.page.evaluate((time_s, place) => {
    understory.seek(time_s);
    const hex = getComputedStyle(document.documentElement).getPropertyValue("--map").trim();
    return [understory.pixel(...understory.project(...place)), [1, 3, 5].map((i) => parseInt(hex.slice(i, i + 2), 16))];
  }, by_name("t").values[moment], place);
  check("memory: what was seen truly lies where it was, whatever the estimate's drift", far_apart(color, expected) < 12, `${color}, expected ${expected}`);
  await close(opened, "memory");
}

/// Flights that lack what others have.
function variants() {
  const list = {};
  const add = (name, change) => {
    const flight = sample_flight();
    change(flight);
    list[name] = flight;
  };
  const drop = (flight, ...names) => (flight.arrays = flight.arrays.filter((array) => !names.includes(array.name)));
  add("no map, hits, plans", (f) => drop(f, "map_points", "map_from", "map_to", "hits", "hits_t", "plan_t", "plan_start", "plan_points", "plan_origin", "plan_clearance"));
  add("no obstacles", (f) => { drop(f, "obstacles"); Object.assign(f.facts, { touched: null, touched_name: undefined, impact: null }); });
  add("no estimate, no camera, no wing", (f) => { drop(f, "estimate", "wing_vertices", "wing_triangles", "wing_tips"); f.facts.camera = null; });
  add("empty charts", (f) => { for (const array of f.arrays) if (/speed|error|clearance/.test(array.name)) array.values = array.values.map(() => NaN); });
  add("one moment", (f) => {
    for (const array of f.arrays) if (array.values.length % f.arrays[0].values.length === 0 && !/hits|map|plan|wing|obstacles/.test(array.name)) array.values = array.values.slice(0, array.components);
    f.arrays[0].values = [0];
    f.facts.t_end_s = 0;
  });
  add("nothing but facts", (f) => { f.arrays = []; Object.assign(f.facts, { charts: [], events: [], course: null, camera: null, impact: null, touched: null, story: [], result: [], keys: [], decimation: [], outcome: "aborted", t_end_s: 0, warning: "The flight was broken off." }); });
  add("unknown estimate", (f) => { const estimate = f.arrays.find((array) => array.name === "estimate"); estimate.values = estimate.values.map((v, i) => (i < 700 ? NaN : v)); });
  add("goal", (f) => { f.facts.outcome = "goal"; });
  return list;
}

/// Checks that measure time want the machine for themselves.
async function check_speeds(given) {
  const sample = sample_flight();
  const dense = sample_flight({ trunks: 1000, end_s: 20 });
  await check_speed(write("sample", sample.facts, sample.arrays), "sample");
  await check_speed(write("dense", dense.facts, dense.arrays), "1000 trunks, 20 s");
  await check_large_campaign();
  for (const each of given) await check_speed(resolve(each), name_of(each));
}

async function check_contents(given) {
  await check_large_campaign();
  const sample = sample_flight();
  const file = write("sample", sample.facts, sample.arrays);
  await check_flight(file, "sample");
  await check_phone(file, "sample");
  await check_film(sample_flight());
  for (const [name, flight] of Object.entries(variants())) {
    const opened = await open(write(name.replaceAll(/\W/g, "_"), flight.facts, flight.arrays));
    check(`${name}: ready`, await opened.page.evaluate(() => window.understory?.ready === true));
    await opened.page.evaluate(() => { // each of them once; the sample's checks do it by hand
      HTMLAnchorElement.prototype.click = () => {};
      for (const button of document.querySelectorAll("button:not(dialog button)")) button.click();
    });
    await opened.settle();
    await close(opened, name);
  }
  await check_memory();
  const blind = await open(file, { before: () => (HTMLCanvasElement.prototype.getContext = ((get) => function (kind, ...more) { return kind.startsWith("webgl") ? null : get.call(this, kind, ...more); })(HTMLCanvasElement.prototype.getContext)) });
  check("without WebGL2: one line, and charts", await blind.page.evaluate(() => understory.ready && document.body.innerText.includes("no WebGL2") && document.querySelectorAll(".u-over").length === 6));
  await blind.page.evaluate(() => ["ArrowLeft", "1", "e", "t"].forEach((key) => document.body.dispatchEvent(new KeyboardEvent("keydown", { key, bubbles: true }))));
  await close(blind, "without WebGL2");
  const empty = await open(new URL("../../../scenarios/report/page/built/page.html", import.meta.url).pathname);
  check("without data: one line", (await empty.page.evaluate(() => document.querySelector(".alone").textContent)).length > 10);
  await close(empty, "without data");
  await check_campaign();
  await check_sheet();
  for (const each of given) {
    const { facts } = read_page(each);
    if (facts.kind === "campaign") {
      await check_given_campaign(resolve(each), facts, name_of(each));
      continue;
    }
    await check_flight(resolve(each), name_of(each));
    await check_phone(resolve(each), name_of(each));
  }
}

const name_of = (file) => basename(dirname(resolve(file)));
const [checks, ...given] = process.argv.slice(2);
try {
  if (checks === "speeds") await check_speeds(given);
  else if (checks === "contents") await check_contents(given);
  else throw new Error(`the first argument is speeds or contents, not ${checks}`);
} finally {
  await end();
}
console.log(failures() === 0 ? "all good" : `${failures()} failed`);
process.exit(failures() === 0 ? 0 : 1);
