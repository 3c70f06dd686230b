// A browser that draws in software, and what every check of a page needs. Ends with status 77 where the browser or a
// library is missing.
import { existsSync, mkdtempSync, rmSync, writeFileSync } from "node:fs";
import { tmpdir } from "node:os";
import { join } from "node:path";
import { fill_page } from "./sample.mjs";

const browser_file = process.env.CHROMIUM || "/usr/bin/chromium";
const libraries = new URL("node_modules/puppeteer-core", import.meta.url);
if (!existsSync(browser_file) || !existsSync(libraries)) {
  console.log(`skipped: ${existsSync(libraries) ? browser_file : "node_modules (npm ci)"} is missing`);
  process.exit(77);
}
const { launch } = (await import("puppeteer-core")).default;
const folder = mkdtempSync(join(tmpdir(), "understory_page_"));
const flags = ["--headless=new", "--no-sandbox", "--use-gl=angle", "--use-angle=swiftshader", "--enable-unsafe-swiftshader"];
const browser = await launch({ executablePath: browser_file, args: flags, timeout: 0, protocolTimeout: 0 });
let failed = 0;

export function check(name, good, details = "") {
  if (!good) ++failed;
  console.log(`${good ? "ok    " : "FAILED"} ${name}${details === "" ? "" : `: ${String(details).replaceAll("\n", " / ")}`}`);
}

/// Opens a file, and notes all that a page must not do: ask for anything outside itself, write to the console.
export async function open(file, { width = 1280, height = 720, theme = "dark", before = undefined } = {}) {
  const page = await browser.newPage();
  page.setDefaultTimeout(0); // a test that hangs is ended by ctest
  const said = [];
  await page.setViewport({ width, height });
  await page.emulateMediaFeatures([{ name: "prefers-color-scheme", value: theme }]);
  await page.setRequestInterception(true);
  page.on("request", (request) => {
    const inside = /^(file|data|blob):/.test(request.url());
    if (!inside) said.push(`asked for ${request.url().slice(0, 80)}`);
    if (inside) request.continue();
    else request.abort();
  });
  page.on("console", (message) => said.push(`console: ${message.text()}`));
  page.on("pageerror", (error) => said.push(`error: ${error.message}`));
  if (before) await page.evaluateOnNewDocument(before);
  const begin_ms = Date.now();
  await page.goto(`file://${file}`);
  await page.waitForFunction("window.understory?.ready || document.querySelector('.alone')");
  const open_s = (Date.now() - begin_ms) / 1000;
  const settle = () => page.evaluate(() => new Promise((done) => requestAnimationFrame(() => requestAnimationFrame(done))));
  await settle();
  return { page, said, open_s, settle };
}

export async function close({ page, said }, name) {
  check(`${name}: silent, asks for nothing`, said.length === 0, said.slice(0, 3).join("; "));
  await page.close();
}

/// A page in a file of its own, removed at the end.
export function write(name, facts, arrays, blocks) {
  const file = join(folder, `${name}.html`);
  writeFileSync(file, fill_page(facts, arrays, blocks));
  return file;
}

export function failures() {
  return failed;
}

export async function end() {
  await browser.close();
  rmSync(folder, { recursive: true });
}
