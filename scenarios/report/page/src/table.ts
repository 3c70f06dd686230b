// A table that is sorted by the buttons in its heading and shows one page of its rows at a time.

import { make, make_button } from "./elements";

export type Cell = string | number | null;

export interface Column {
  label: string;
  unit?: string;
  value(row: number): Cell; // what is shown, and sorted by
  show?(row: number): Node; // instead of the value
}

const rows_on_a_page = 100;
const words = new Intl.Collator(undefined, { numeric: true });

/// Unknown values are the last ones, in both directions.
function compare(a: Cell, b: Cell, direction: number): number {
  const [a_unknown, b_unknown] = [a, b].map((value) => value === null || Number.isNaN(value));
  if (a_unknown || b_unknown) return Number(a_unknown) - Number(b_unknown);
  if (typeof a === "number" && typeof b === "number") return (a - b) * direction;
  return words.compare(String(a), String(b)) * direction;
}

/// How many decimals the numbers of a column need: three digits of the greatest one, none where all are whole.
function decimals_of(values: Cell[]): number {
  let greatest = 0;
  let whole = true;
  for (const value of values) {
    if (typeof value !== "number" || Number.isNaN(value)) continue;
    greatest = Math.max(greatest, Math.abs(value));
    whole &&= Number.isInteger(value);
  }
  return whole ? 0 : Math.min(Math.max(2 - Math.floor(Math.log10(greatest)), 0), 6);
}

/// Adds a table of no rows yet to `place`. Returns what shows the given rows in the chosen order.
export function add_table(place: HTMLElement, label: string, columns: Column[]): (rows: number[]) => void {
  const table = make("table", "", "sorted");
  table.setAttribute("aria-label", label);
  const heading = table.appendChild(make("thead", "")).appendChild(make("tr", ""));
  const body = table.appendChild(make("tbody", ""));
  const pages = make("nav", "", "pages");
  pages.setAttribute("aria-label", `Pages of ${label}`);
  const told = make("output", "");
  const back = make_button("◂", "", () => turn(-rows_on_a_page));
  const on = make_button("▸", "", () => turn(rows_on_a_page));
  back.ariaLabel = "Rows before";
  on.ariaLabel = "Rows after";
  pages.append(back, told, on);
  const frame = place.appendChild(make("div", "", "wide"));
  frame.append(table);
  place.append(pages);

  let shown: number[] = [];
  let first = 0;
  let sorted_by = -1;
  let direction = 1;
  let decimals: number[] = [];
  let numeric: boolean[] = [];
  columns.forEach((column, index) => {
    const head = heading.appendChild(make("th", ""));
    head.scope = "col";
    head.append(make_button(column.label + (column.unit && column.unit !== "1" ? ` (${column.unit})` : ""), "", () => {
      direction = sorted_by === index ? -direction : 1;
      sorted_by = index;
      sort();
    }));
  });

  function sort(): void {
    const column = columns[sorted_by];
    if (column) shown.sort((a, b) => compare(column.value(a), column.value(b), direction) || a - b);
    [...heading.children].forEach((head, i) => (head.ariaSort = i !== sorted_by ? "none" : direction > 0 ? "ascending" : "descending"));
    first = 0;
    fill();
  }

  function measure(): void {
    const values = columns.map((column) => shown.map((row) => column.value(row)));
    decimals = values.map(decimals_of);
    numeric = values.map((column) => column.some((value) => typeof value === "number"));
    [...heading.children].forEach((head, i) => head.classList.toggle("number", numeric[i]));
  }

  function turn(step: number): void {
    first += step;
    fill();
    frame.scrollIntoView({ block: "nearest" });
  }

  function fill(): void {
    const end = Math.min(first + rows_on_a_page, shown.length);
    body.replaceChildren(...shown.slice(first, end).map(make_row));
    told.textContent = shown.length === 0 ? "No rows." : `${first + 1}–${end} of ${shown.length}`;
    back.disabled = first === 0;
    on.disabled = end === shown.length;
    pages.hidden = shown.length > 0 && shown.length <= rows_on_a_page;
  }

  function make_row(row: number): HTMLElement {
    const line = make("tr", "");
    columns.forEach(({ value, show }, i) => {
      const told = value(row);
      const text = told === null || Number.isNaN(told) ? "–" : typeof told === "number" ? told.toFixed(decimals[i]) : told;
      const cell = line.appendChild(make("td", show ? "" : text, numeric[i] && !show ? "number" : text.length > 30 ? "long" : ""));
      if (show) cell.append(show(row));
    });
    return line;
  }

  return (rows) => {
    shown = [...rows];
    measure();
    sort();
  };
}
