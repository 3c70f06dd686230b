// The page of one flight: puts the facts into the layout and joins replay, film and charts by one clock.

import { add_charts } from "./charts";
import { Clock } from "./clock";
import { add_controls } from "./controls";
import { array_of, floats_of, type Arrays } from "./data";
import type { EventFact, FlightFacts } from "./facts";
import { find, hide_section, lay_out, make, show_rows, show_text } from "./elements";
import { add_film } from "./film";
import { Replay } from "./scene";
import { add_sections } from "./sheet_page";

const lost_start_s = 1; // before the end: there a lost flight is interesting

export const outcomes: Record<string, string> = {
  goal: "goal", collision: "collision", ground: "ground", out_of_bounds: "out of bounds", time: "time over", aborted: "aborted", not_flown: "not flown",
};

function show_list(root: HTMLElement, name: string, sentences: string[] | undefined): void {
  const place = find(root, `[data-show="${name}"]`);
  for (const sentence of sentences ?? []) place.append(make("li", sentence));
  if (!sentences?.length) hide_section(place);
}

function show_words(root: HTMLElement, facts: FlightFacts): void {
  const lost = facts.outcome !== "goal";
  show_text(root, "title", facts.title);
  show_text(root, "outcome", outcomes[facts.outcome] ?? facts.outcome);
  find(root, ".outcome").classList.toggle("lost", lost);
  show_text(root, "sentence", facts.sentence);
  show_text(root, "warning", facts.warning);
  show_list(root, "story", facts.story);
  show_rows(root, ".result", [], facts.result, "No result.");
  show_rows(root, ".keys", ["key", "default", "here"], facts.keys, "All keys have their defaults.");
  show_text(root, "command", facts.command);
  show_text(root, "origin", [facts.program, facts.digest && `digest ${facts.digest}`].filter(Boolean).join(" · "));
  show_list(root, "decimation", facts.decimation);
}

/// From the first moment to the last: of the arrays, or of the facts where the arrays are empty.
function time_span(facts: FlightFacts, times: Float32Array): [number, number] {
  const begin_s = times.length > 0 ? times[0] : 0;
  const last_s = times.length > 0 ? times[times.length - 1] : begin_s;
  return [begin_s, Math.max(begin_s, last_s, facts.t_end_s || 0)];
}

function show_events(root: HTMLElement, events: EventFact[], clock: Clock): void {
  const list = find(root, ".events");
  const marks = find(root, ".marks");
  const rows: HTMLElement[] = [];
  for (const event of events) {
    const row = make("button", "", `event k-event-${event.kind}`);
    row.append(make("time", `${event.t_s.toFixed(2)} s`), make("span", event.text));
    row.addEventListener("click", () => clock.seek(event.t_s));
    list.appendChild(make("li", "")).append(row);
    rows.push(row);
    const mark = marks.appendChild(make("i", "", `k-event-${event.kind}`));
    mark.style.left = `${(100 * (event.t_s - clock.begin_s)) / Math.max(clock.end_s - clock.begin_s, 1e-6)}%`;
  }
  if (events.length === 0) list.append(make("li", "None.", "quiet"));
  clock.subscribe(() => rows.forEach((row, i) => row.classList.toggle("past", events[i].t_s <= clock.time_s + 1e-4)));
}

function show_transport(root: HTMLElement, clock: Clock): void {
  const scrub = find<HTMLInputElement>(root, ".scrub input");
  Object.assign(scrub, { min: clock.begin_s, max: clock.end_s, step: "any" });
  scrub.addEventListener("input", () => clock.seek(Number(scrub.value)));
  clock.subscribe(() => {
    scrub.value = String(clock.time_s);
    find(root, ".time").textContent = `${clock.time_s.toFixed(2)} / ${clock.end_s.toFixed(2)} s`;
    find(root, ".rate").textContent = `${clock.rate}×`;
    find(root, '[data-action="play"]').textContent = clock.playing ? "⏸" : "▶";
  });
}

/// null, and a line in its place, where the browser has no WebGL2.
function add_replay(root: HTMLElement, facts: FlightFacts, arrays: Arrays, changed: () => void): Replay | null {
  try {
    return new Replay(find<HTMLCanvasElement>(root, ".replay canvas"), facts, arrays, changed);
  } catch {
    find(root, ".replay").replaceChildren(make("p", "This browser has no WebGL2: no replay in three dimensions.", "alone"));
    return null;
  }
}

/// Draws once per picture of the browser, and only after something changed.
function make_painter(draw: () => void): () => void {
  let requested = false;
  return () => {
    if (requested) return;
    requested = true;
    requestAnimationFrame(() => {
      requested = false;
      draw();
    });
  };
}

/// The label at the impact follows it over the picture. Returns what moves it.
function add_label(root: HTMLElement, facts: FlightFacts, replay: Replay | null): () => void {
  if (!replay || !facts.impact) return () => {};
  const { part, position } = facts.impact;
  const touched = facts.touched_name;
  const label = find(root, ".label");
  label.textContent = [part.replaceAll("_", " "), touched].filter(Boolean).join(" · ");
  return () => {
    const at = replay.project(...position);
    const [width_px, height_px] = [replay.canvas.clientWidth, replay.canvas.clientHeight];
    label.hidden = at === null || at[0] < 0 || at[1] < 0 || at[0] > width_px || at[1] > height_px;
    if (!at) return;
    const left = Math.min(at[0] + 14, width_px - label.offsetWidth - 4); // within the picture
    label.style.transform = `translate(${left.toFixed(1)}px, ${at[1].toFixed(1)}px)`;
  };
}

/// Draws the replay in the size that the layout gives it. A resized canvas is empty: it is drawn at once.
function keep_size(place: HTMLElement, replay: Replay, draw: () => void): ResizeObserver {
  const resize = () => {
    replay.resize(replay.canvas.clientWidth, replay.canvas.clientHeight);
    draw();
  };
  const sizes = new ResizeObserver(resize);
  sizes.observe(place);
  resize();
  return sizes;
}

/// For tests.
function offer_handles(clock: Clock, replay: Replay | null, actions: Record<string, () => void>): void {
  const handles = {
    ready: true,
    time: () => clock.time_s,
    playing: () => clock.playing,
    seek: (time_s: number) => clock.seek(time_s),
    play: () => clock.play(),
    pause: () => clock.pause(),
    view: (name: string) => actions[name](),
    project: (x: number, y: number, z: number) => (replay?.draw(clock.time_s), replay?.project(x, y, z) ?? null),
    pixel: (x: number, y: number) => replay?.pixel(x, y) ?? null,
    triangles: () => replay?.triangles() ?? 0,
    draw_seconds: (count: number) => replay?.draw_seconds(count) ?? null,
  };
  Object.assign(window, { understory: handles });
}

/// Shows a flight in `root`. Returns what ends it and gives back what it holds.
export function show_flight(root: HTMLElement, facts: FlightFacts, arrays: Arrays): () => void {
  lay_out(root, "flight");
  const components = new Map((facts.arrays ?? []).map((array) => [array.name, array.components]));
  const clock = new Clock(...time_span(facts, floats_of(arrays, "t")));
  if (facts.outcome !== "goal") clock.seek(clock.end_s - lost_start_s);
  const events = facts.events ?? [];

  show_words(root, facts);
  show_events(root, events, clock);
  show_transport(root, clock);
  add_sections(find(root, ".chapter"), find(root, ".tip"), facts.sections ?? [], arrays);
  const draw = () => {
    replay?.draw(clock.time_s);
    place_label();
  };
  const paint = make_painter(draw);
  const replay = add_replay(root, facts, arrays, paint);
  const place_label = add_label(root, facts, replay);
  const charts = add_charts(find(root, ".charts"), find(root, ".tip"), facts.charts ?? [], events, arrays, components, clock);
  add_film(find(root, ".film"), facts.film ? array_of(arrays, facts.film.times) : new Float32Array(0), clock);
  clock.subscribe(() => {
    paint();
    charts.update();
  });
  const actions = add_controls(root, facts, clock, replay, charts, paint);
  replay?.set_theme();
  const sizes = replay && keep_size(find(root, ".replay"), replay, draw);
  actions.follow();
  actions.whole();
  offer_handles(clock, replay, actions);
  return () => {
    clock.close();
    sizes?.disconnect();
    charts.close();
    replay?.close();
  };
}
