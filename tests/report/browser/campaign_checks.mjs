// The pages of campaigns and sheets: every control, and the texts against the facts.
import { check, close, open, write } from "./browser.mjs";
import { sample_campaign, sample_sheet } from "./sample.mjs";

const texts = (page, selector) => page.$$eval(selector, (found) => found.map((each) => each.innerText.trim()));
const text = async (page, selector) => (await texts(page, selector))[0];
const same = (a, b) => JSON.stringify(a) === JSON.stringify(b);

/// The texts of one column of a table.
async function column(page, table, heading) {
  const index = (await texts(page, `${table} thead th`)).findIndex((each) => each.startsWith(heading));
  return texts(page, `${table} tbody td:nth-child(${index + 1})`);
}

async function sort_by(page, table, heading) {
  const index = (await texts(page, `${table} thead th`)).findIndex((each) => each.startsWith(heading));
  await page.click(`${table} th:nth-child(${index + 1}) button`);
  return page.$eval(`${table} th:nth-child(${index + 1})`, (head) => head.ariaSort);
}

/// Contexts of the graphics card that the page still holds.
function count_contexts() {
  const get = HTMLCanvasElement.prototype.getContext;
  window.contexts = new Set();
  HTMLCanvasElement.prototype.getContext = function (kind, ...more) {
    const context = get.call(this, kind, ...more);
    if (kind.startsWith("webgl") && context) window.contexts.add(context);
    return context;
  };
  window.held = () => [...window.contexts].filter((context) => !context.isContextLost()).length;
}

const click_replay = (page, index) => page.evaluate((index) => {
  const buttons = [...document.querySelectorAll(".row_buttons button")].filter((button) => button.textContent === "replay");
  buttons[index % buttons.length].focus();
  buttons[index % buttons.length].click();
}, index);

async function check_charts(page, facts) {
  const shares = await texts(page, ".share");
  check("campaign: a line a condition says its goals", facts.conditions.every(({ label, goals, flown }, i) => shares[i].includes(label) && shares[i].includes(`${goals}/${flown}`)));
  const { goals, flown, lower } = facts.conditions[1];
  const said = (tip) => tip.includes(`${goals} of ${flown}`) && tip.includes(`${(100 * lower).toFixed(0)} % to`);
  await page.hover(".share:nth-child(2) .track");
  check("campaign: pointing tells the interval", said(await text(page, ".tip")), await text(page, ".tip"));
  await page.mouse.move(2, 2);
  await page.focus(".share:nth-child(2)");
  check("campaign: so do the keys", said(await text(page, ".tip")));

  await page.$eval(".plot svg", (picture) => picture.focus());
  await page.keyboard.press("ArrowRight");
  check("campaign: keys go along the survival", (await text(page, ".tip")).includes(facts.conditions[0].label), await text(page, ".tip"));
  await page.keyboard.press("ArrowDown");
  check("campaign: and to the next curve", (await text(page, ".tip")).includes(facts.conditions[1].label));
  const [x, y] = await page.$eval(".plot .marker", (marker) => { const box = marker.getBoundingClientRect(); return [box.x + box.width / 2, box.y + box.height / 2]; });
  await page.mouse.move(x + 3, y + 3);
  check("campaign: pointing at the survival tells a point", /share still flying: [01]/.test(await text(page, ".tip")));
  await page.click(".plot figcaption button:nth-child(2)");
  check("campaign: the legend hides a curve", (await page.$$(".plot .values")).length === facts.conditions.length - 1);
  await page.click(".plot figcaption button:nth-child(2)");
}

async function check_map(page, facts) {
  const [first, second] = facts.grid_keys;
  const selected = () => page.$$eval(".map select", (selects) => selects.map((select) => select.value));
  const found = facts.conditions.find(({ keys }) => keys[first] === "12" && keys[second] === "20");
  check("campaign: the map says goals of flights", (await texts(page, ".map tr:nth-child(2) td:nth-child(3)"))[0].includes(`${found.goals}/${found.flown}`));
  await page.select('.map select[name="across"]', second);
  check("campaign: choosing the other key swaps the two", same(await selected(), [second, first]), await selected());
  check("campaign: and turns the map", (await texts(page, ".map tr:nth-child(3) td:nth-child(2)"))[0].includes(`${found.goals}/${found.flown}`));
}

async function check_table(page, facts, outcomes, progress) {
  const table = ".flights .sorted";
  const total = facts.rows.ids.length;
  const told = () => text(page, ".flights .pages output");
  check("campaign: a page of all flights", (await told()) === `1–100 of ${total}` && (await page.$$(`${table} tbody tr`)).length === 100, await told());
  await page.click(".flights .pages button:last-child");
  check("campaign: the next page", (await told()) === `101–200 of ${total}`);
  await page.click(".flights .pages button:first-child");

  const finite = progress.filter(Number.isFinite).sort((a, b) => a - b);
  check("campaign: sorts", (await sort_by(page, table, "progress")) === "ascending");
  check("campaign: the smallest first", (await column(page, table, "progress"))[0] === finite[0].toFixed(1));
  check("campaign: sorts back", (await sort_by(page, table, "progress")) === "descending");
  check("campaign: the greatest first, the unknown last", (await column(page, table, "progress"))[0] === finite.at(-1).toFixed(1));
  await page.keyboard.press("Enter");
  check("campaign: Enter on the heading sorts", (await column(page, table, "progress"))[0] === finite[0].toFixed(1));
  for (const heading of ["condition", "seed", "outcome", "time", "touched", "how it ended", "again"]) await sort_by(page, table, heading);
  check("campaign: flights with a replay first", (await column(page, table, "again")).slice(0, 20).every((each) => each.startsWith("replay")));

  const lost = outcomes.filter((outcome) => outcome === 1).length;
  await page.select('.flights select[name="outcome"]', "1");
  check("campaign: filters by outcome", (await told()).endsWith(` ${lost}`) && (await column(page, table, "outcome")).every((each) => each === "collision"), await told());
  const [label, seeds] = [facts.conditions[3].label, facts.conditions[3].flights];
  await page.select('.flights select[name="condition"]', "3");
  check("campaign: filters by condition", (await column(page, table, "condition")).every((each) => each === label));
  await page.select('.flights select[name="outcome"]', "");
  await page.click(".share:nth-child(4)");
  check("campaign: a condition's line shows its flights", (await told()).endsWith(` ${seeds}`), await told());
  await page.select('.flights select[name="condition"]', "");
  const touched = facts.rows.touched.find(Boolean);
  await page.type(".flights input", touched);
  check("campaign: filters by text", (await column(page, table, "touched")).every((each) => each === touched) && !(await told()).startsWith("No"));
  await page.type(".flights input", "nothing");
  check("campaign: says where nothing is left", (await told()) === "No rows.");
  await page.$eval(".flights input", (input) => { input.value = ""; input.dispatchEvent(new Event("input")); });

  const row = facts.rows.ids.indexOf(facts.rows.ids[Number(Object.keys(facts.tracks)[0])]);
  await page.$eval('.row_buttons button[title^="Copies"]', (button) => button.click());
  check("campaign: shows the command", (await text(page, ".chosen")) === facts.rows.commands[row], await text(page, ".chosen"));
  await page.waitForFunction(() => [...document.querySelectorAll(".row_buttons button")].some((button) => /Copied|Selected/.test(button.textContent)));
}

async function check_gate(page, facts) {
  const { title, pairs } = facts.gate;
  check("campaign: says the verdict", (await text(page, ".gate h2")) === title && (await texts(page, ".gate li")).length === facts.gate.lines.length);
  const differing = pairs.filter((pair) => pair[2] !== pair[3]);
  const seeds = () => column(page, ".pairs .sorted", "seed");
  check("campaign: the pairs that differ first", same(await seeds(), differing.map((pair) => String(pair[1]))));
  await page.click('[data-action="pairs"]');
  check("campaign: all pairs", (await text(page, ".pairs output")).endsWith(` ${pairs.length}`));
  await page.click('[data-action="pairs"]');
  check("campaign: and back", (await seeds()).length === differing.length);
}

async function check_replays({ page, settle }, facts) {
  const open_panel = () => page.$(".panel[open]");
  const rows = Object.keys(facts.tracks).map(Number);
  await click_replay(page, 0);
  await settle();
  check("replay: shows the flight", (await text(page, ".panel h1")) === facts.rows.ids[rows[0]] && (await page.$$(".panel .u-over")).length === 3, await text(page, ".panel h1"));
  check("replay: says the command", (await text(page, '.panel [data-show="command"]')) === facts.rows.commands[rows[0]]);
  const moved = await page.evaluate(() => { const before = understory.time(); understory.seek(1); return before !== 1 && understory.time() === 1 && understory.triangles() > 100; });
  check("replay: draws and seeks", moved);
  await page.keyboard.press("End");
  check("replay: has the keys", await page.evaluate(() => understory.time() > 2.9));
  await page.keyboard.press("?");
  await page.keyboard.press("Escape");
  await settle();
  check("replay: Escape closes its help first", (await open_panel()) !== null && !(await page.$(".panel dialog[open]")));
  await page.keyboard.press("Escape");
  await settle();
  check("replay: Escape closes it", (await open_panel()) === null);
  check("replay: the keys are back at the button", (await page.evaluate(() => document.activeElement.textContent)) === "replay");
  await page.keyboard.press("Enter");
  await settle();
  await page.click('.panel [data-action="play"]');
  await page.click(".panel .close");
  await settle();
  check("replay: opens by Enter, closes by mouse", (await open_panel()) === null);
  for (let i = 0; i < 30; ++i) {
    await click_replay(page, i); // draws its first picture at once
    if (i === 29) check("replay: holds one context", (await page.evaluate(() => held())) === 1);
    await page.keyboard.press("Escape");
  }
  await settle();
  check("replay: 30 of them leave no context and no element", (await page.evaluate(() => held() === 0 && document.querySelectorAll("canvas").length === 0)), await page.evaluate(() => held()));
}

async function check_phone(file, name) {
  const phone = await open(file, { width: 400, height: 800, theme: "light" });
  const wide = () => phone.page.evaluate(() => document.documentElement.scrollWidth);
  check(`${name}: no sideways scrolling at 400 px`, (await wide()) <= 400, await wide());
  if (await phone.page.$(".row_buttons")) {
    await click_replay(phone.page, 0);
    await phone.settle();
    check(`${name}: nor in a replay`, (await phone.page.$eval(".panel", (panel) => panel.scrollWidth <= panel.clientWidth)));
  }
  await close(phone, `${name} at 400 px`);
}

export async function check_campaign() {
  const { facts, arrays, blocks } = sample_campaign();
  const values = (name) => arrays.find((array) => array.name === name).values;
  const file = write("campaign", facts, arrays, blocks);
  const opened = await open(file, { before: count_contexts });
  const { page } = opened;
  check("campaign: says what it found", (await text(page, ".sentence")) === facts.sentence);
  await check_gate(page, facts);
  await check_charts(page, facts);
  await check_map(page, facts);
  await check_table(page, facts, values("row_outcome"), values("column_progress_m"));
  await check_replays(opened, facts);
  const theme = () => page.evaluate(() => document.documentElement.dataset.theme);
  const before = await theme();
  await page.click('[data-action="theme"]');
  check("campaign: both themes", (await theme()) !== before);
  await page.keyboard.press("t");
  check("campaign: t changes them, too", (await theme()) === before);
  await close(opened, "campaign");
  const [linked] = Object.keys(facts.tracks).map(Number);
  const link = await open(`${file}#${facts.rows.ids[linked]}`);
  check("campaign: a comment's link opens the replay", (await text(link.page, ".panel h1")).length > 0);
  await close(link, "campaign, a replay linked");
  await check_phone(file, "campaign");
}

/// A campaign of 1,000 flights: opened, sorted and searched in the time that people wait.
export async function check_large_campaign() {
  const large = sample_campaign({ seeds: 250, gate: false });
  large.facts.grid_keys.length = 1;
  const [damaged] = Object.values(large.facts.tracks);
  large.blocks[damaged] = "AAAA";
  const slow = await open(write("large", large.facts, large.arrays, large.blocks));
  console.log(`       1,000 flights: opens in ${slow.open_s.toFixed(2)} s`);
  check("1,000 flights: no gate, no replay asked for", await slow.page.$eval(".gate", (gate) => gate.hidden));
  check("1,000 flights: a map of one key is a line", (await slow.page.$$(".map tr")).length === 2 && !(await slow.page.$eval('select[name="down"]', (select) => select.checkVisibility())));
  const sorted_ms = await slow.page.evaluate(() => {
    const begin_ms = performance.now();
    document.querySelector(".flights th:nth-child(2) button").click();
    return performance.now() - begin_ms;
  });
  console.log(`       1,000 flights: sorted in ${sorted_ms.toFixed(0)} ms`);
  await slow.page.select('.flights select[name="outcome"]', "1");
  await slow.page.type(".flights input", large.facts.rows.touched.find(Boolean));
  await slow.page.evaluate((row) => document.querySelector(`[aria-label="Replay ${row}"]`).click(), large.facts.rows.ids[Number(Object.keys(large.facts.tracks)[0])]);
  check("a damaged replay: says so", (await text(slow.page, ".panel")).includes("damaged"));
  await close(slow, "1,000 flights");
}

/// A page that `understory` made.
export async function check_given_campaign(file, facts, name) {
  const opened = await open(file);
  const told = await text(opened.page, "body");
  check(`${name}: says what it found`, told.includes(facts.sentence));
  check(`${name}: has all conditions`, facts.conditions.every((each) => told.includes(each.label)));
  await click_replay(opened.page, 0);
  await opened.settle();
  const command = await text(opened.page, '.panel [data-show="command"]');
  const row = Object.keys(facts.tracks)[0];
  check(`${name}: replays a lost flight`, (await opened.page.evaluate(() => understory.triangles())) > 100 && (await text(opened.page, ".panel")).includes(facts.rows.reasons[row]));
  check(`${name}: with its command`, command === facts.rows.commands[row], command);
  await opened.page.keyboard.press("Escape");
  await close(opened, name);
}

export async function check_sheet() {
  const { facts, arrays, blocks } = sample_sheet();
  const file = write("sheet", facts, arrays, blocks);
  const opened = await open(file);
  const { page } = opened;
  const all = await text(page, "body");
  check("sheet: says everything", [facts.sentence, facts.warning, facts.program, ...facts.sections.map((each) => each.title), facts.sections[0].text].every((each) => all.includes(each)));
  check("sheet: shows its plots", (await page.$$(".plot")).length === 2 && (await page.$$(".values")).length === 3);
  check("sheet: names places in the place of numbers", ["first", "last"].every((name) => all.includes(name)));
  await page.$eval("section:nth-child(2) .plot svg", (picture) => picture.focus());
  for (const key of ["ArrowRight", "ArrowRight"]) await page.keyboard.press(key);
  check("sheet: tells a point, its label and interval", same((await text(page, ".tip")).split("\n"), ["trials", "horizon 2 s", "trial: 2.00", "share of goals: 0.61 (0.50 … 0.70)"]), await text(page, ".tip"));
  await sort_by(page, ".sorted", "share");
  check("sheet: sorts its tables, the unknown last", same(await column(page, ".sorted", "trial"), ["1", "2", "10"]));
  await sort_by(page, ".sorted", "trial");
  await sort_by(page, ".sorted", "trial");
  check("sheet: sorts numbers as numbers", same(await column(page, ".sorted", "trial"), ["10", "2", "1"]));
  check("sheet: shows pictures", (await page.$eval(".picture img", (image) => image.naturalWidth)) === 1 && all.includes("the picture is missing"));
  await close(opened, "sheet");
  await check_phone(file, "sheet");
}
