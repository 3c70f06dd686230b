// What a campaign's conditions reached: their shares of goals with intervals, and a map of them over two keys.

import { find, make, show_tip } from "./elements";
import type { Condition } from "./facts";

function percent(share: number | null): string {
  return share === null ? "–" : `${(100 * share).toFixed(0)} %`;
}

function say_condition({ label, goals, flown, flights, share, lower, upper, between_crashes_km }: Condition): string {
  const lines = [label, `${goals} of ${flown} reached the goal: ${percent(share)}`];
  if (share !== null) lines.push(`95 % interval: ${percent(lower)} to ${percent(upper)}`);
  if (between_crashes_km !== "") lines.push(`${between_crashes_km} km between crashes`);
  if (flights > flown) lines.push(`${flights - flown} of ${flights} not flown`);
  return lines.join("\n");
}

/// One line a condition. `choose` is told the index of the one that was pressed.
export function add_shares(place: HTMLElement, tip: HTMLElement, conditions: Condition[], choose: (index: number) => void): void {
  conditions.forEach((condition, index) => {
    const { label, goals, flown, share, lower, upper, between_crashes_km } = condition;
    const line = place.appendChild(make("button", "", "share"));
    const track = make("span", "", "track");
    if (share !== null) {
      const interval = track.appendChild(make("i", "", "interval"));
      interval.style.left = `${100 * (lower ?? share)}%`;
      interval.style.right = `${100 - 100 * (upper ?? share)}%`;
      track.appendChild(make("i", "", "dot")).style.left = `${100 * share}%`;
    }
    const range = share === null ? "" : `${(100 * (lower ?? share)).toFixed(0)}–${(100 * (upper ?? share)).toFixed(0)}`;
    line.append(make("span", label), track, make("b", percent(share)), make("span", `${goals}/${flown}`), make("span", range, "quiet"));
    if (between_crashes_km !== "") line.append(make("span", `${between_crashes_km} km between crashes`, "quiet between"));
    line.ariaLabel = `${say_condition(condition).replaceAll("\n", "; ")}. Shows its flights.`;
    const tell = (x_px: number, y_px: number) => show_tip(tip, say_condition(condition), x_px, y_px);
    line.addEventListener("pointermove", (event) => tell(event.clientX, event.clientY));
    line.addEventListener("focus", () => tell(track.getBoundingClientRect().left, line.getBoundingClientRect().bottom));
    for (const end of ["pointerleave", "blur"]) line.addEventListener(end, () => show_tip(tip, "", 0, 0));
    line.addEventListener("click", () => choose(index));
  });
}

const in_order = new Intl.Collator(undefined, { numeric: true });

/// The values that a key has in the conditions. Numbers go by size, not by their letters.
function values_of(conditions: Condition[], key: string): string[] {
  const values = [...new Set(conditions.map((condition) => condition.keys[key] ?? ""))];
  const numbers = values.every((value) => value !== "" && Number.isFinite(Number(value)));
  return values.sort((a, b) => (numbers ? Number(a) - Number(b) : in_order.compare(a, b)));
}

function make_cell(found: Condition[]): HTMLElement {
  const sum = (of: "goals" | "flown") => found.reduce((total, condition) => total + condition[of], 0);
  const [goals, flown] = [sum("goals"), sum("flown")];
  const cell = make("td", "");
  if (flown === 0) return cell;
  // By the third power: most questions are about the last fifth, where shares must not look alike.
  cell.style.setProperty("--share", percent((goals / flown) ** 3).replace(" ", ""));
  cell.className = "known";
  cell.append(make("b", percent(goals / flown)), make("span", `${goals}/${flown}`));
  cell.title = found.map((condition) => condition.label).join("\n");
  return cell;
}

/// Two keys chosen by selects span the map; conditions that agree in both are counted together. Of one key: a line.
export function add_map(place: HTMLElement, conditions: Condition[], keys: string[]): void {
  place.hidden = keys.length === 0;
  if (place.hidden) return;
  const [across, down] = ["across", "down"].map((name) => find<HTMLSelectElement>(place, `select[name="${name}"]`));
  for (const select of [across, down]) select.append(...keys.map((key) => new Option(key)));
  down.parentElement!.hidden = keys.length === 1;
  if (keys.length > 1) down.selectedIndex = 1;
  let [last_across, last_down] = [across.value, down.value];

  function draw(): void {
    const line = keys.length === 1;
    if (!line && across.value === down.value) [across.value, down.value] = [last_down, last_across]; // they change places
    [last_across, last_down] = [across.value, down.value];
    const columns = values_of(conditions, across.value);
    const table = find(place, "table");
    const heading = make("tr", "");
    heading.append(...(line ? [] : [make("th", "")]), ...columns.map((value) => make("th", value)));
    table.replaceChildren(heading);
    for (const value of line ? [""] : values_of(conditions, down.value)) {
      const row = table.appendChild(make("tr", ""));
      if (!line) row.append(make("th", value));
      row.append(...columns.map((column) => make_cell(conditions.filter(({ keys }) =>
        (keys[across.value] ?? "") === column && (line || (keys[down.value] ?? "") === value)))));
    }
  }
  for (const select of [across, down]) select.addEventListener("change", draw);
  draw();
}
