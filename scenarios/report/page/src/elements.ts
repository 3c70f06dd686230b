// Finds, makes and fills the elements of the pages.

export function find<T extends HTMLElement>(root: ParentNode, selector: string): T {
  return root.querySelector<T>(selector)!;
}

export function make<Tag extends keyof HTMLElementTagNameMap>(tag: Tag, text: string, class_name = ""): HTMLElementTagNameMap[Tag] {
  return Object.assign(document.createElement(tag), { textContent: text, className: class_name });
}

export function make_button(text: string, class_name: string, press: () => void): HTMLButtonElement {
  const button = make("button", text, class_name);
  button.addEventListener("click", press);
  return button;
}

/// Puts the layout of a kind of page, a template of page.html, into `root`.
export function lay_out(root: HTMLElement, kind: string): void {
  root.append(find<HTMLTemplateElement>(document, `template#${kind}`).content.cloneNode(true));
}

/// Puts text where the layout says data-show="name"; hides the place where there is none.
export function show_text(root: HTMLElement, name: string, text: string | undefined): void {
  const place = find(root, `[data-show="${name}"]`);
  place.textContent = text ?? "";
  place.hidden = !text;
}

/// Hides an element and the heading before it.
export function hide_section(place: HTMLElement): void {
  place.hidden = true;
  const heading = place.previousElementSibling;
  if (heading instanceof HTMLHeadingElement) heading.hidden = true;
}

/// Fills a table; without rows it says `empty`, and where nothing is known of rows it is hidden.
export function show_rows(root: HTMLElement, selector: string, heading: string[], rows: string[][] | undefined, empty: string): void {
  const table = find(root, selector);
  if (!rows) hide_section(table);
  else if (rows.length === 0) table.append(make("caption", empty));
  else for (const cells of [heading, ...rows]) {
    if (cells.length === 0) continue;
    const row = table.appendChild(make("tr", ""));
    for (const cell of cells) row.append(make(cells === heading ? "th" : "td", cell));
  }
}

/// A value as people read it; the unit "1" is not said.
export function say_number(value: number | null | undefined, unit: string): string {
  if (value == null || Number.isNaN(value)) return "–";
  const size = Math.abs(value);
  return `${value.toFixed(size >= 100 ? 0 : size >= 10 ? 1 : 2)}${unit && unit !== "1" ? ` ${unit}` : ""}`;
}

/// Shows the text beside a place of the window, within the window; no text hides it.
export function show_tip(tip: HTMLElement, text: string, x_px: number, y_px: number): void {
  tip.hidden = text === "";
  tip.textContent = text;
  const left = Math.min(x_px + 12, window.innerWidth - tip.offsetWidth - 8);
  const top = Math.min(y_px + 14, window.innerHeight - tip.offsetHeight - 4);
  tip.style.transform = `translate(${Math.max(left, 4)}px, ${Math.max(top, 4)}px)`;
}

export function change_theme(): void {
  const page = document.documentElement.dataset;
  page.theme = page.theme === "dark" ? "light" : "dark";
}

/// The heading of the pages that are not of one flight.
export function show_heading(root: HTMLElement, facts: { title: string; sentence?: string; warning?: string; program?: string }): void {
  for (const name of ["title", "sentence", "warning", "program"] as const) show_text(root, name, facts[name]);
  find(root, '[data-action="theme"]').addEventListener("click", change_theme);
  root.addEventListener("keydown", (event) => {
    const typing = event.target instanceof Element && event.target.closest("input, select, dialog");
    if (event.key === "t" && !typing && !event.ctrlKey && !event.metaKey && !event.altKey) change_theme();
  });
}

/// Copies the text and says so on the button. Some browsers keep the clipboard from files: there `shown`, which holds
/// the text, is selected, to copy it by hand.
export function copy_text(button: HTMLElement, text: string, shown: HTMLElement): void {
  const label = (button.dataset.label ??= button.textContent!);
  const tell = (word: string) => {
    button.textContent = word;
    setTimeout(() => (button.textContent = label), 1200);
  };
  const refused = () => {
    getSelection()?.selectAllChildren(shown);
    tell("Selected");
  };
  if (navigator.clipboard) navigator.clipboard.writeText(text).then(() => tell("Copied"), refused);
  else refused();
}
