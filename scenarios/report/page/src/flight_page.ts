// The page of one flight: puts the facts into the layout and joins replay, film and charts by one clock.

import { add_charts, type Charts } from "./charts";
import { Clock } from "./clock";
import { array_of, floats_of, read_arrays, type Arrays } from "./data";
import type { EventFact, FlightFacts } from "./facts";
import { add_film } from "./film";
import type { ViewName } from "./orbit";
import { Replay, type Layer } from "./scene";

const moment_s = 1 / 120;
const lost_start_s = 1; // before the end: there a lost flight is interesting

const endings = {
  goal: "goal", collision: "collision", ground: "ground", out_of_bounds: "out of bounds", time: "time over", aborted: "aborted",
};

const help: [string, string][] = [
  ["space", "play or pause"],
  ["← →", "one moment (1/120 s) back or forward"],
  ["shift ← →", "0.1 s back or forward"],
  ["Home End", "to the start, to the end"],
  ["+ −", "faster, slower"],
  ["1 2 3 4", "follow, orbit, onboard, top view"],
  ["0", "the whole course"],
  ["e m h p f", "estimate, map, hits, plan, cameras' common view"],
  ["t", "dark or light"],
  ["?", "this help"],
  ["mouse", "drag: turn; right or shift drag: move; wheel: zoom; on a chart: seek"],
];

const keys: Record<string, string> = {
  " ": "play", ArrowLeft: "back", ArrowRight: "forward", "shift ArrowLeft": "far_back", "shift ArrowRight": "far_forward",
  Home: "begin", End: "end", "+": "faster", "=": "faster", "-": "slower", "1": "follow", "2": "orbit", "3": "onboard",
  "4": "top", "0": "fit", e: "estimate", m: "map", h: "hits", p: "plan", f: "frusta", t: "theme", "?": "help",
};

function find<T extends HTMLElement>(selector: string): T {
  return document.querySelector<T>(selector)!;
}

function make(tag: string, text: string, class_name = ""): HTMLElement {
  return Object.assign(document.createElement(tag), { textContent: text, className: class_name });
}

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

function show_rows(selector: string, heading: string[], rows: string[][] | undefined, empty: string): void {
  const table = find(selector);
  for (const [cells, tag] of [[heading, "th"], ...(rows ?? []).map((row) => [row, "td"])] as [string[], string][]) {
    if (cells.length === 0 || !rows?.length) continue;
    const row = table.appendChild(make("tr", ""));
    for (const cell of cells) row.append(make(tag, cell));
  }
  if (!rows?.length) table.append(make("caption", empty));
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
  show_rows(".help", [], help, "");
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

function copy(button: HTMLElement, text: string): void {
  const said = button.textContent;
  const tell = (word: string) => {
    button.textContent = word;
    setTimeout(() => (button.textContent = said), 1200);
  };
  const refused = () => { // some browsers keep the clipboard from files: select the command to copy by hand
    getSelection()?.selectAllChildren(find('[data-show="command"]'));
    tell("Selected");
  };
  if (navigator.clipboard) navigator.clipboard.writeText(text).then(() => tell("Copied"), refused);
  else refused();
}

function download(name: string, text: string): void {
  const address = URL.createObjectURL(new Blob([text], { type: "text/yaml" }));
  Object.assign(document.createElement("a"), { href: address, download: name }).click();
  setTimeout(() => URL.revokeObjectURL(address), 1000);
}

function set_theme(theme: string, replay: Replay | null, charts: Charts, paint: () => void): void {
  document.documentElement.dataset.theme = theme;
  replay?.set_theme();
  charts.redraw();
  paint();
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
  const paint = make_painter(() => {
    replay?.draw(clock.time_s);
    place_label();
  });
  const replay = add_replay(facts, arrays, paint);
  const label = replay && facts.impact ? find(".label") : null;
  const touched_name = facts.touched != null ? facts.obstacles?.names[facts.touched] : undefined;
  if (facts.impact) label?.append([facts.impact.part.replaceAll("_", " "), touched_name].filter(Boolean).join(" · "));
  function place_label(): void {
    if (!label || !replay) return;
    const at = replay.project(...facts.impact!.position);
    label.hidden = at === null || at[0] < 0 || at[1] < 0 || at[0] > replay.canvas.clientWidth || at[1] > replay.canvas.clientHeight;
    if (!at) return;
    const left = Math.min(at[0] + 14, replay.canvas.clientWidth - label.offsetWidth - 4); // within the picture
    label.style.transform = `translate(${left.toFixed(1)}px, ${at[1].toFixed(1)}px)`;
  }

  show_events(events, clock);
  show_transport(clock);
  const charts = add_charts(find(".charts"), find(".tip"), facts.charts ?? [], events, arrays, components, clock);
  add_film(find(".film"), facts.film ? array_of(arrays, facts.film.times) : new Float32Array(0), clock);
  clock.subscribe(() => {
    paint();
    charts.update();
  });

  const show_state = () => {
    for (const view of ["follow", "orbit", "onboard", "top"]) press(view, replay?.orbit.view === view);
    for (const [layer, shown] of Object.entries(replay?.layers ?? {})) press(layer, shown);
  };
  const press = (action: string, pressed: boolean) => document.querySelector(`[data-action="${action}"]`)?.setAttribute("aria-pressed", String(pressed));
  const view = (name: ViewName) => () => {
    replay?.set_view(name);
    show_state();
    paint();
  };
  const toggle = (layer: Layer) => () => {
    if (replay) replay.layers[layer] = !replay.layers[layer];
    show_state();
    paint();
  };
  const step = (seconds: number) => () => {
    clock.pause();
    clock.seek(clock.time_s + seconds);
  };
  const span = (begin_s: number, name: string) => () => {
    charts.show(Math.max(begin_s, clock.begin_s), clock.end_s);
    for (const each of ["whole", "last2", "last05"]) press(each, each === name);
  };
  const actions: Record<string, () => void> = {
    play: () => (clock.playing ? clock.pause() : clock.play()),
    back: step(-moment_s), forward: step(moment_s), far_back: step(-0.1), far_forward: step(0.1),
    begin: () => clock.seek(clock.begin_s), end: () => clock.seek(clock.end_s),
    slower: () => clock.change_rate(-1), faster: () => clock.change_rate(1),
    follow: view("follow"), orbit: view("orbit"), onboard: view("onboard"), top: view("top"),
    fit: () => {
      replay?.fit();
      show_state();
      paint();
    },
    estimate: toggle("estimate"), map: toggle("map"), hits: toggle("hits"), plan: toggle("plan"), frusta: toggle("frusta"),
    whole: span(-Infinity, "whole"), last2: span(clock.end_s - 2, "last2"), last05: span(clock.end_s - 0.5, "last05"),
    copy: () => copy(find('[data-action="copy"]'), facts.command ?? ""),
    download: () => download("scenario.yaml", facts.scenario ?? ""),
    theme: () => set_theme(document.documentElement.dataset.theme === "dark" ? "light" : "dark", replay, charts, paint),
    help: () => {
      const dialog = find<HTMLDialogElement>("dialog");
      if (dialog.open) dialog.close();
      else dialog.showModal();
    },
  };
  find('[data-action="copy"]').hidden = !facts.command;
  find('[data-action="download"]').hidden = !facts.scenario;
  for (const button of document.querySelectorAll<HTMLElement>("[data-action]")) {
    button.addEventListener("click", () => actions[button.dataset.action!]());
  }
  document.addEventListener("keydown", (event) => {
    if (event.ctrlKey || event.metaKey || event.altKey) return;
    if (event.key === " " && event.target instanceof HTMLButtonElement) return; // the button is pressed instead
    const shift = event.shiftKey && event.key.startsWith("Arrow") ? "shift " : "";
    const action = actions[keys[shift + (event.key.length === 1 ? event.key.toLowerCase() : event.key)]];
    if (!action) return;
    event.preventDefault();
    action();
  });
  replay?.canvas.addEventListener("pointermove", show_state);
  find(".replay").addEventListener("dblclick", () => actions.play());
  new ResizeObserver(() => {
    if (!replay) return;
    replay.resize(replay.canvas.clientWidth, replay.canvas.clientHeight);
    replay.draw(clock.time_s); // at once: a resized canvas is empty
    place_label();
  }).observe(find(".replay"));
  if (replay) replay.resize(replay.canvas.clientWidth, replay.canvas.clientHeight);
  replay?.set_theme();
  replay?.draw(clock.time_s);
  actions.follow();
  actions.whole();

  Object.assign(window, {
    understory: {
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
    },
  });
}
