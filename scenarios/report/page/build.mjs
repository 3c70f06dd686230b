// Makes built/page.html: the template with the style, the program and the licences of its libraries inlined.
// The same sources give the same bytes, so that CI can compare.
import { buildSync } from "esbuild";
import { mkdirSync, readFileSync, writeFileSync } from "node:fs";

process.chdir(import.meta.dirname);
const read = (file) => readFileSync(file, "utf8");
const version = (library) => JSON.parse(read(`node_modules/${library}/package.json`)).version;
const minify = { minify: true, write: false, legalComments: "none", charset: "ascii", logLevel: "warning" };
const bundle = (file, more) => buildSync({ entryPoints: [file], bundle: true, ...minify, ...more }).outputFiles[0].text.trim();

const parts = {
  LICENCES: `Made by \`npm run build\` in scenarios/report/page. It contains two libraries.

ogl ${version("ogl")} (github.com/oframe/ogl): The Unlicense, in the public domain.

uPlot ${version("uplot")} (github.com/leeoniya/uPlot):
${read("node_modules/uplot/LICENSE").replace(/\r/g, "").trim()}`,
  STYLE: bundle("src/page.css", {}),
  PROGRAM: bundle("src/main.ts", { format: "iife", target: "es2022" }),
};
let page = read("src/page.html");
for (const [name, text] of Object.entries(parts)) page = page.replace(`@${name}@`, () => text);
for (const once of ["<!--DATA-->", "<title>Understory</title>"])
  if (page.split(once).length !== 2) throw new Error(`the page must hold ${once} exactly once`);
mkdirSync("built", { recursive: true });
writeFileSync("built/page.html", page);
console.log(`built/page.html: ${page.length} bytes`);
