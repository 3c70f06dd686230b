// Finds and makes the elements of the page.

export function find<T extends HTMLElement>(selector: string): T {
  return document.querySelector<T>(selector)!;
}

export function make(tag: string, text: string, class_name = ""): HTMLElement {
  return Object.assign(document.createElement(tag), { textContent: text, className: class_name });
}

/// Fills a table; without rows it says `empty`.
export function show_rows(selector: string, heading: string[], rows: string[][] | undefined, empty: string): void {
  const table = find(selector);
  for (const [cells, tag] of [[heading, "th"], ...(rows ?? []).map((row) => [row, "td"])] as [string[], string][]) {
    if (cells.length === 0 || !rows?.length) continue;
    const row = table.appendChild(make("tr", ""));
    for (const cell of cells) row.append(make(tag, cell));
  }
  if (!rows?.length) table.append(make("caption", empty));
}
