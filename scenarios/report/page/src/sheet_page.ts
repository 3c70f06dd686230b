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

export function add_sections(place: HTMLElement, tip: HTMLElement, sections: SectionFact[], arrays: Arrays): void {
  for (const { title, text, plot, table, pictures } of sections) {
    const section = place.appendChild(make("section", ""));
    section.ariaLabel = title;
    section.append(make("h2", title));
    if (text) section.append(make("p", text, "text"));
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
