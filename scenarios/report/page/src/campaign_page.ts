// The page of a campaign: what its conditions reached, all its flights, and the replay of lost ones.

import { add_map, add_shares } from "./campaign_charts";
import { array_of, floats_of, read_track, type Arrays } from "./data";
import { copy_text, find, hide_section, lay_out, make, make_button, show_heading, show_text } from "./elements";
import type { CampaignFacts, GateFact } from "./facts";
import { outcomes, show_flight } from "./flight_page";
import { add_plot, type Series } from "./plot";
import { add_sections } from "./sheet_page";
import { add_table, type Column } from "./table";

function make_outcome(outcome: string): HTMLElement {
  const kind = outcome === "goal" ? "" : outcome === "not_flown" ? "unknown" : "lost";
  return make("span", outcomes[outcome] ?? outcome, `outcome ${kind}`);
}

function show_gate(root: HTMLElement, gate: GateFact | null | undefined): void {
  const place = find(root, ".gate");
  place.hidden = !gate;
  if (!gate) return;
  place.classList.add(gate.verdict);
  find(place, "h2").textContent = gate.title;
  for (const line of gate.lines ?? []) find(place, "ul").append(make("li", line));
  const pairs = gate.pairs ?? [];
  const differing = [...pairs.keys()].filter((i) => pairs[i][2] !== pairs[i][3]);
  const outcome = (label: string, index: 2 | 3): Column =>
    ({ label, value: (row) => pairs[row][index], show: (row) => make_outcome(pairs[row][index]) });
  const show = add_table(find(place, ".pairs"), "seed by seed", [
    { label: "condition", value: (row) => pairs[row][0] },
    { label: "seed", value: (row) => pairs[row][1] },
    outcome(gate.baseline, 2),
    outcome(gate.candidate, 3),
  ]);
  const all = find(place, '[data-action="pairs"]');
  find(place, ".differing").textContent = `${differing.length} of ${pairs.length} seeds end otherwise.`;
  const choose = (every: boolean) => {
    all.ariaPressed = String(every);
    show(every ? [...pairs.keys()] : differing);
  };
  all.addEventListener("click", () => choose(all.ariaPressed !== "true"));
  choose(false);
}

const most_bands = 4;

function show_survival(root: HTMLElement, facts: CampaignFacts, arrays: Arrays): void {
  const place = find(root, ".survival");
  const series = (facts.survival ?? []).map(({ condition, array }): Series => {
    const steps = floats_of(arrays, array);
    const column = (k: number) => steps.filter((_, i) => i % 4 === k);
    const bands = (facts.survival ?? []).length <= most_bands ? { lower: column(2), upper: column(3) } : {}; // more of them hide each other
    return { name: facts.conditions[condition].label, x: column(0), y: column(1), ...bands, mark: "steps" };
  });
  if (series.length === 0) hide_section(place);
  else add_plot(place, find(root, ".tip"), { title: "Survival", x_label: "distance, m", y_label: "share still flying" }, series);
}

/// For tests.
function offer_handles(): void {
  Object.assign(window, { understory: { ready: true } });
}

/// Shows the flight of one block over the page until it is closed.
function open_replay(root: HTMLElement, block: string, command: string): void {
  const panel = root.appendChild(document.createElement("dialog"));
  panel.className = "panel";
  panel.tabIndex = -1; // a click between its buttons leaves the keys with the panel
  panel.ariaLabel = "Replay";
  let end_flight = () => {};
  panel.addEventListener("close", (event) => {
    if (event.target !== panel) return; // its help was closed
    end_flight();
    panel.remove();
    offer_handles(); // the flight's would keep all of it in memory
  });
  panel.showModal(); // before the flight, whose replay needs its size
  try {
    const { facts, arrays } = read_track(block);
    end_flight = show_flight(panel, { ...facts, command: facts.command || command }, arrays);
  } catch (error) {
    panel.append(make("p", `This replay is damaged: ${error instanceof Error ? error.message : error}`, "alone"));
  }
  const close = make_button("Close", "close", () => panel.close());
  close.title = "Escape";
  (panel.querySelector(".buttons") ?? panel).append(close);
  panel.focus();
}

/// The table of all flights with its filters. Returns what shows the flights of one condition.
function show_flights(root: HTMLElement, facts: CampaignFacts, arrays: Arrays): (condition: number) => void {
  const { conditions, rows, tracks = {} } = facts;
  const row_condition = array_of(arrays, "row_condition");
  const row_outcome = array_of(arrays, "row_outcome");
  const place = find(root, ".flights");
  const [condition, outcome] = ["condition", "outcome"].map((name) => find<HTMLSelectElement>(place, `select[name="${name}"]`));
  const text = find<HTMLInputElement>(place, "input");
  condition.append(new Option("all conditions", ""), ...conditions.map(({ label }, i) => new Option(label, String(i))));
  outcome.append(new Option("all outcomes", ""), ...facts.outcomes.map((name, i) => new Option(outcomes[name] ?? name, String(i))));

  function copy_command(button: HTMLElement, row: number): void {
    show_text(root, "chosen", rows.commands[row]);
    copy_text(button, rows.commands[row], find(root, '[data-show="chosen"]'));
  }

  function make_buttons(row: number): HTMLElement {
    const buttons = make("span", "", "row_buttons");
    if (tracks[row]) {
      const replay = make_button("replay", "", () => open_replay(root, tracks[row], rows.commands[row]));
      replay.ariaLabel = `Replay ${rows.ids[row]}`;
      buttons.append(replay);
    }
    if (rows.commands[row]) {
      const copy = make_button("command", "", () => copy_command(copy, row));
      copy.title = "Copies the command that flies it again";
      buttons.append(copy);
    }
    return buttons;
  }

  const outcome_of = (row: number) => facts.outcomes[row_outcome[row]] ?? "";
  const show = add_table(find(place, ".all"), "all flights", [
    { label: "condition", value: (row) => conditions[row_condition[row]]?.label ?? null },
    { label: "seed", value: (row) => rows.seeds[row] },
    { label: "outcome", value: (row) => outcomes[outcome_of(row)] ?? outcome_of(row), show: (row) => make_outcome(outcome_of(row)) },
    { label: "again", value: (row) => (tracks[row] ? "replay" : "without"), show: make_buttons }, // sorts those with a replay first
    { label: "how it ended", value: (row) => rows.reasons[row] || null },
    ...(facts.columns ?? []).map(({ name, label, unit }): Column => {
      const numbers = array_of(arrays, `column_${name}`);
      return { label, unit, value: (row) => numbers[row] ?? null };
    }),
    { label: "touched", value: (row) => rows.touched[row] || null },
  ]);
  // People come for the lost ones.
  const in_order = [...rows.ids.keys()].sort((a, b) => Number(b in tracks) - Number(a in tracks) || a - b);

  const searched = rows.ids.map((id, row) => [id, rows.seeds[row], rows.touched[row], rows.reasons[row]].join("\n").toLowerCase());
  function filter(): void {
    const wanted = text.value.trim().toLowerCase();
    show(in_order.filter((row) =>
      (condition.value === "" || row_condition[row] === Number(condition.value)) &&
      (outcome.value === "" || row_outcome[row] === Number(outcome.value)) &&
      searched[row].includes(wanted)));
  }
  for (const control of [condition, outcome, text]) control.addEventListener("input", filter);
  filter();
  return (index) => {
    condition.value = String(index);
    filter();
    place.scrollIntoView();
  };
}

export function show_campaign(root: HTMLElement, facts: CampaignFacts, arrays: Arrays): void {
  lay_out(root, "campaign");
  show_heading(root, facts);
  show_gate(root, facts.gate);
  const choose_condition = show_flights(root, facts, arrays);
  add_shares(find(root, ".shares"), find(root, ".tip"), facts.conditions, choose_condition);
  show_survival(root, facts, arrays);
  add_sections(find(root, ".chapter"), find(root, ".tip"), facts.sections ?? [], arrays);
  add_map(find(root, ".map"), facts.conditions, facts.grid_keys ?? []);
  offer_handles();
  const linked = facts.rows.ids.indexOf(decodeURIComponent(location.hash.slice(1))); // a comment's link: page.html#forest-7
  if (facts.tracks?.[linked]) open_replay(root, facts.tracks[linked], facts.rows.commands[linked]);
}
