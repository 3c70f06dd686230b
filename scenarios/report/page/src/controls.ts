// What buttons and keys do. A button names its action: data-action="play".

import type { Charts } from "./charts";
import type { Clock } from "./clock";
import { change_theme, copy_text, find, show_rows } from "./elements";
import type { FlightFacts } from "./facts";
import type { ViewName } from "./orbit";
import type { Layer, Replay } from "./scene";

type Actions = Record<string, () => void>;

const moment_s = 1 / 120;
const views: ViewName[] = ["follow", "orbit", "onboard", "top"];
const layers: Layer[] = ["estimate", "map", "hits", "plan", "frusta"];

const keys: Record<string, string> = {
  " ": "play", ArrowLeft: "back", ArrowRight: "forward", "shift ArrowLeft": "far_back", "shift ArrowRight": "far_forward",
  Home: "begin", End: "end", "+": "faster", "=": "faster", "-": "slower", "1": "follow", "2": "orbit", "3": "onboard",
  "4": "top", "0": "fit", e: "estimate", m: "map", h: "hits", p: "plan", f: "frusta", t: "theme", v: "large", "?": "help",
};

const help: [string, string][] = [
  ["space", "play or pause"],
  ["← →", "one moment (1/120 s) back or forward"],
  ["shift ← →", "0.1 s back or forward"],
  ["Home End", "to the start, to the end"],
  ["+ −", "faster, slower"],
  ["1 2 3 4", "follow, orbit, onboard, top view"],
  ["0", "the whole course"],
  ["e m h p f", "estimate, map, detections, plan, cameras' common view"],
  ["map, plan", "Drawn as the aircraft believes they lie relative to itself: what it remembers of a trunk lies at that trunk, unless it was detected wrongly."],
  ["t", "dark or light"],
  ["v", "the video large or small"],
  ["Escape", "close this help, or the replay of a campaign"],
  ["?", "this help"],
  ["mouse", "drag: turn; right or shift drag: move; wheel: zoom; on a chart: seek"],
];

function download(name: string, text: string): void {
  const address = URL.createObjectURL(new Blob([text], { type: "text/yaml" }));
  Object.assign(document.createElement("a"), { href: address, download: name }).click();
  setTimeout(() => URL.revokeObjectURL(address), 1000);
}

function press(root: HTMLElement, action: string, pressed: boolean): void {
  root.querySelector(`[data-action="${action}"]`)?.setAttribute("aria-pressed", String(pressed));
}

function clock_actions(clock: Clock): Actions {
  const step = (seconds: number) => () => {
    clock.pause();
    clock.seek(clock.time_s + seconds);
  };
  return {
    play: () => (clock.playing ? clock.pause() : clock.play()),
    back: step(-moment_s), forward: step(moment_s), far_back: step(-0.1), far_forward: step(0.1),
    begin: () => clock.seek(clock.begin_s), end: () => clock.seek(clock.end_s),
    slower: () => clock.change_rate(-1), faster: () => clock.change_rate(1),
  };
}

function replay_actions(root: HTMLElement, replay: Replay | null, paint: () => void): Actions {
  const actions: Actions = {};
  const show_state = () => {
    for (const view of views) press(root, view, replay?.orbit.view === view);
    for (const layer of layers) press(root, layer, replay?.layers[layer] ?? false);
    paint();
  };
  const add = (name: string, change: (replay: Replay) => void) => {
    actions[name] = () => {
      if (replay) change(replay);
      show_state();
    };
  };
  for (const view of views) add(view, (replay) => replay.set_view(view));
  for (const layer of layers) add(layer, (replay) => (replay.layers[layer] = !replay.layers[layer]));
  add("fit", (replay) => replay.fit());
  replay?.canvas.addEventListener("pointerup", show_state); // a drag may have left the follow or the top view
  return actions;
}

function page_actions(root: HTMLElement, facts: FlightFacts, clock: Clock, replay: Replay | null, charts: Charts, paint: () => void): Actions {
  const spans: Record<string, number> = { whole: Infinity, last2: 2, last05: 0.5 };
  const span = (name: string) => () => {
    charts.show(Math.max(clock.end_s - spans[name], clock.begin_s), clock.end_s);
    for (const each of Object.keys(spans)) press(root, each, each === name);
  };
  return {
    whole: span("whole"), last2: span("last2"), last05: span("last05"),
    copy: () => copy_text(find(root, '[data-action="copy"]'), facts.command ?? "", find(root, '[data-show="command"]')),
    download: () => download("scenario.yaml", facts.scenario ?? ""),
    large: () => {
      find(root, ".film").classList.toggle("large");
    },
    theme: () => {
      change_theme();
      replay?.set_theme();
      charts.redraw();
      paint();
    },
    help: () => {
      const dialog = find<HTMLDialogElement>(root, "dialog");
      if (dialog.open) dialog.close();
      else dialog.showModal();
    },
  };
}

/// Joins the buttons and keys of `root` and keys to what they do.
export function add_controls(root: HTMLElement, facts: FlightFacts, clock: Clock, replay: Replay | null, charts: Charts, paint: () => void): Actions {
  const actions = { ...clock_actions(clock), ...replay_actions(root, replay, paint), ...page_actions(root, facts, clock, replay, charts, paint) };
  show_rows(root, ".help", [], help, "");
  find(root, '[data-action="copy"]').hidden = !facts.command;
  find(root, '[data-action="download"]').hidden = !facts.scenario;
  for (const button of root.querySelectorAll<HTMLElement>("[data-action]")) {
    button.addEventListener("click", () => actions[button.dataset.action!]());
  }
  root.addEventListener("keydown", (event) => {
    if (event.ctrlKey || event.metaKey || event.altKey) return;
    if (event.key === " " && event.target instanceof HTMLButtonElement) return; // the button is pressed instead
    const shift = event.shiftKey && event.key.startsWith("Arrow") ? "shift " : "";
    const action = actions[keys[shift + (event.key.length === 1 ? event.key.toLowerCase() : event.key)]];
    if (!action) return;
    event.preventDefault();
    action();
  });
  return actions;
}
