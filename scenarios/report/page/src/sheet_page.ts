// A page of sections: text, plot, table and pictures. `evaluate` and `tune` write it.

import { floats_of, take_bytes, type Arrays } from "./data";
import { find, lay_out, make, show_heading } from "./elements";
import type { PlotFact, SectionFact, SheetFacts } from "./facts";
import { add_plot, type Series } from "./plot";
import { add_table, type Cell, type Column } from "./table";

function read_series(plot: PlotFact, arrays: Arrays): Series[] {
  return plot.series.map(({ x, y, lower, upper, ...words }) => ({
    ...words, x: floats_of(arrays, x), y: floats_of(arrays, y),
    ...(lower && upper && { lower: floats_of(arrays, lower), upper: floats_of(arrays, upper) }),
  }));
}

function add_rows(place: HTMLElement, title: string, columns: { label: string; unit?: string }[], rows: Cell[][]): void {
  const readers = columns.map((column, i): Column => ({ ...column, value: (row) => rows[row][i] ?? null }));
  add_table(place, title, readers)([...rows.keys()]);
}

function add_picture(place: HTMLElement, caption: string, block: string, type: string): void {
  const bytes = take_bytes(block);
  const figure = place.appendChild(make("figure", "", "picture"));
  if (bytes) {
    const image = figure.appendChild(document.createElement("img"));
    image.alt = caption;
    image.src = URL.createObjectURL(new Blob([bytes], { type }));
  }
  figure.append(make("figcaption", bytes ? caption : `${caption} (the picture is missing)`));
}

/// Parts side by side, as wide as their shares; each says its name and number.
function add_bars(place: HTMLElement, bars: { name: string; parts: [string, number][] }[]): void {
  for (const { name, parts } of bars) {
    place.append(make("p", name, "quiet"));
    const bar = place.appendChild(make("div", "", "stack"));
    const sum = parts.reduce((total, [, value]) => total + value, 0);
    parts.forEach(([part, value], i) => {
      if (value === 0) return;
      const piece = bar.appendChild(make("span", `${part} ${value}`, `s${i % 8}`));
      piece.style.flexGrow = String(value / sum);
      piece.title = `${part}: ${value} of ${sum}`;
    });
  }
}

export function add_sections(place: HTMLElement, tip: HTMLElement, sections: SectionFact[], arrays: Arrays): void {
  for (const { title, text, bars, plot, table, pictures } of sections) {
    const section = place.appendChild(make("section", ""));
    section.ariaLabel = title;
    section.append(make("h2", title));
    if (text) section.append(make("p", text, "text"));
    if (bars) add_bars(section, bars);
    if (plot) add_plot(section, tip, { ...plot, title }, read_series(plot, arrays));
    if (table) add_rows(section, title, table.columns, table.rows);
    for (const { caption, block, type } of pictures ?? []) add_picture(section, caption, block, type);
  }
}

export function show_sheet(root: HTMLElement, facts: SheetFacts, arrays: Arrays): void {
  lay_out(root, "sheet");
  show_heading(root, facts);
  add_sections(find(root, "main"), find(root, ".tip"), facts.sections ?? [], arrays);
  Object.assign(window, { understory: { ready: true } });
}
