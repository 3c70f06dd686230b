// The page of one flight: puts the facts into the layout and joins replay, film and charts by one clock.

import { add_charts } from "./charts";
import { Clock } from "./clock";
import { add_controls } from "./controls";
import { array_of, floats_of, read_arrays, type Arrays } from "./data";
import type { EventFact, FlightFacts } from "./facts";
import { find, make, show_rows } from "./elements";
import { add_film } from "./film";
import { Replay } from "./scene";

const lost_start_s = 1; // before the end: there a lost flight is interesting

const endings = {
  goal: "goal", collision: "collision", ground: "ground", out_of_bounds: "out of bounds", time: "time over", aborted: "aborted",
};

/// Puts text where the layout says data-show="name"; hides the place where there is none.
function show_text(name: string, text: string | undefined): void {
  const place = find(`[data-show="${name}"]`);
  place.textContent = text ?? "";
  place.hidden = !text;
}

function show_list(name: string, sentences: string[] | undefined): void {
  const place = find(`[data-show="${name}"]`);
  for (const sentence of sentences ?? []) place.append(make("li", sentence));
  place.hidden = !sentences?.length;
  const heading = place.previousElementSibling;
  if (place.hidden && heading?.tagName === "H2") (heading as HTMLElement).hidden = true;
}

function show_words(facts: FlightFacts): void {
  const lost = facts.ending !== "goal";
  document.title = `Understory: ${facts.title}`;
  show_text("title", facts.title);
  show_text("ending", endings[facts.ending] ?? facts.ending);
  find(".ending").classList.toggle("lost", lost);
  show_text("sentence", facts.sentence);
  show_text("warning", facts.warning);
  show_list("story", facts.story);
  show_rows(".result", [], facts.result, "No result.");
  show_rows(".keys", ["key", "default", "here"], facts.keys, "All keys have their defaults.");
  show_text("command", facts.command);
  show_text("origin", [facts.program, facts.digest && `digest ${facts.digest}`].filter(Boolean).join(" · "));
  show_list("decimation", facts.decimation);
}

/// From the first moment to the last: of the arrays, or of the facts where the arrays are empty.
function time_span(facts: FlightFacts, times: Float32Array): [number, number] {
  const begin_s = times.length > 0 ? times[0] : 0;
  const last_s = times.length > 0 ? times[times.length - 1] : begin_s;
  return [begin_s, Math.max(begin_s, last_s, facts.t_end_s || 0)];
}

function show_events(events: EventFact[], clock: Clock): void {
  const list = find(".events");
  const marks = find(".marks");
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

function show_transport(clock: Clock): void {
  const scrub = find<HTMLInputElement>(".scrub input");
  Object.assign(scrub, { min: clock.begin_s, max: clock.end_s, step: "any" });
  scrub.addEventListener("input", () => clock.seek(Number(scrub.value)));
  clock.subscribe(() => {
    scrub.value = String(clock.time_s);
    find(".time").textContent = `${clock.time_s.toFixed(2)} / ${clock.end_s.toFixed(2)} s`;
    find(".rate").textContent = `${clock.rate}×`;
    find('[data-action="play"]').textContent = clock.playing ? "⏸" : "▶";
  });
}

/// null, and a line in its place, where the browser has no WebGL2.
function add_replay(facts: FlightFacts, arrays: Arrays, changed: () => void): Replay | null {
  try {
    return new Replay(find<HTMLCanvasElement>(".replay canvas"), facts, arrays, changed);
  } catch {
    find(".replay").replaceChildren(make("p", "This browser has no WebGL2: no replay in three dimensions.", "alone"));
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
function add_label(facts: FlightFacts, replay: Replay | null): () => void {
  if (!replay || !facts.impact) return () => {};
  const { part, position } = facts.impact;
  const touched = facts.touched != null ? facts.obstacles?.names[facts.touched] : undefined;
  const label = find(".label");
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
function keep_size(replay: Replay, draw: () => void): void {
  const resize = () => {
    replay.resize(replay.canvas.clientWidth, replay.canvas.clientHeight);
    draw();
  };
  new ResizeObserver(resize).observe(find(".replay"));
  resize();
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

export function show_flight(facts: FlightFacts): void {
  const dark = window.matchMedia("(prefers-color-scheme: dark)").matches;
  document.documentElement.dataset.theme = dark ? "dark" : "light";
  document.body.append(find<HTMLTemplateElement>("template#flight").content.cloneNode(true));
  const arrays = read_arrays(facts.arrays ?? []);
  const components = new Map((facts.arrays ?? []).map((array) => [array.name, array.components]));
  const clock = new Clock(...time_span(facts, floats_of(arrays, "t")));
  if (facts.ending !== "goal") clock.seek(clock.end_s - lost_start_s);
  const events = facts.events ?? [];

  show_words(facts);
  show_events(events, clock);
  show_transport(clock);
  const draw = () => {
    replay?.draw(clock.time_s);
    place_label();
  };
  const paint = make_painter(draw);
  const replay = add_replay(facts, arrays, paint);
  const place_label = add_label(facts, replay);
  const charts = add_charts(find(".charts"), find(".tip"), facts.charts ?? [], events, arrays, components, clock);
  add_film(find(".film"), facts.film ? array_of(arrays, facts.film.times) : new Float32Array(0), clock);
  clock.subscribe(() => {
    paint();
    charts.update();
  });
  const actions = add_controls(facts, clock, replay, charts, paint);
  replay?.set_theme();
  if (replay) keep_size(replay, draw);
  actions.follow();
  actions.whole();
  offer_handles(clock, replay, actions);
}
