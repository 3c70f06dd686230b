// Curves, steps and points with their intervals over one axis, as SVG: the page's style colours it.

import { make, make_button, say_number, show_tip } from "./elements";
import type { Mark, PlotFact } from "./facts";

export interface Series {
  name: string;
  x: ArrayLike<number>;
  y: ArrayLike<number>;
  lower?: ArrayLike<number>;
  upper?: ArrayLike<number>;
  mark: Mark;
  labels?: string[];
}

type PlotWords = Omit<PlotFact, "series"> & { title: string };

const height_px = 300;
const margin_px = { left: 52, right: 12, top: 10, bottom: 40 };
const colors = 8; // then they repeat, dashed
const reach_px = 40; // how near to a point one has to point at

function svg(tag: string, attributes: Record<string, string | number>, text = ""): SVGElement {
  const element = document.createElementNS("http://www.w3.org/2000/svg", tag);
  for (const [name, value] of Object.entries(attributes)) element.setAttribute(name, String(value));
  element.textContent = text;
  return element;
}

/// Ticks from the lowest to the highest finite value: whole steps, about `count`. margin: a share of the range, on both sides.
function find_ticks(lists: ArrayLike<number>[], count: number, margin = 0): number[] {
  let [low, high] = [Infinity, -Infinity];
  for (const list of lists) {
    for (let i = 0; i < list.length; ++i) {
      if (!Number.isFinite(list[i])) continue;
      low = Math.min(low, list[i]);
      high = Math.max(high, list[i]);
    }
  }
  if (low > high) [low, high] = [0, 1];
  if (low === high) [low, high] = [low - (Math.abs(low) || 1) / 2, high + (Math.abs(high) || 1) / 2];
  [low, high] = [low - margin * (high - low), high + margin * (high - low)];
  const rough = (high - low) / count;
  const power = 10 ** Math.floor(Math.log10(rough));
  const step = power * [1, 2, 5, 10].find((factor) => factor * power >= rough * 0.999)!;
  const first = Math.floor(low / step + 1e-6);
  const last = Math.ceil(high / step - 1e-6);
  return Array.from({ length: last - first + 1 }, (_, i) => Number(((first + i) * step).toPrecision(12)));
}

/// The interval of a curve is a surface; of points, lines.
function interval_path(series: Series, at: (x: number, y: number) => string): string {
  const { x, lower, upper, mark } = series;
  if (!lower || !upper) return "";
  const known = [...Array(x.length).keys()].filter((i) => Number.isFinite(lower[i]) && Number.isFinite(upper[i]));
  if (mark === "points") return known.map((i) => `M${at(x[i], lower[i])}L${at(x[i], upper[i])}`).join("");
  const edge = (y: ArrayLike<number>) => known.flatMap((i, k) =>
    mark === "steps" && k > 0 ? [at(x[i], y[known[k - 1]]), at(x[i], y[i])] : [at(x[i], y[i])]);
  return known.length > 0 ? `M${[...edge(upper), ...edge(lower).reverse()].join("L")}Z` : "";
}

function value_path({ x, y, mark }: Series, at: (x: number, y: number) => string): string {
  let path = "";
  let last = NaN;
  for (let i = 0; i < x.length; ++i) {
    if (mark === "points" && Number.isFinite(y[i])) path += `M${at(x[i], y[i])}h0`; // a round cap makes it a dot
    else if (Number.isFinite(y[i])) {
      if (mark === "steps" && Number.isFinite(last)) path += `L${at(x[i], last)}`;
      path += `${Number.isFinite(last) ? "L" : "M"}${at(x[i], y[i])}`;
    }
    last = y[i];
  }
  return path;
}

function say_point(words: PlotWords, series: Series, i: number): string {
  const interval = series.lower && series.upper ? ` (${say_number(series.lower[i], "")} … ${say_number(series.upper[i], "")})` : "";
  const lines = [series.name, series.labels?.[i], `${words.x_label}: ${say_number(series.x[i], "")}`, `${words.y_label}: ${say_number(series.y[i], "")}${interval}`];
  return lines.filter(Boolean).join("\n");
}

/// Adds the plot and its legend, whose buttons hide series. One may point at the points, or go along them by arrow keys.
export function add_plot(place: HTMLElement, tip: HTMLElement, words: PlotWords, all: Series[]): void {
  const box = place.appendChild(make("figure", "", "plot"));
  const legend = box.appendChild(make("figcaption", ""));
  const picture = box.appendChild(svg("svg", { tabindex: 0, role: "img" }));
  picture.ariaLabel = `${words.title}: ${words.y_label} over ${words.x_label}. The arrow keys go along its points.`;
  const hidden = new Set<Series>();
  const marker = svg("circle", { r: 5, class: "marker" });
  let chosen: [Series, number] | null = null;
  let pixel = (_x: number, _y: number): [number, number] => [0, 0];

  all.forEach((series, index) => {
    const button = make_button(series.name, `s${index % colors}`, () => {
      if (!hidden.delete(series)) hidden.add(series);
      button.ariaPressed = String(!hidden.has(series));
      draw();
    });
    button.ariaPressed = "true";
    legend.append(button);
  });

  function draw(): void {
    const width_px = Math.max(box.clientWidth, 200);
    const shown = all.filter((series) => !hidden.has(series));
    const references = words.references ?? [];
    const referred = (vertical: boolean) => references.filter((line) => line.vertical === vertical).map((line) => line.at);
    const x_ticks = find_ticks([...shown.map((series) => series.x), referred(true)], width_px / 90, shown.some(({ mark }) => mark === "points") ? 0.03 : 0);
    const y_ticks = find_ticks(shown.flatMap(({ y, lower, upper }) => [y, lower ?? [], upper ?? []]).concat([referred(false)]), 5);
    const place_on = (ticks: number[], from_px: number, to_px: number) => (value: number) =>
      from_px + ((value - ticks[0]) / (ticks[ticks.length - 1] - ticks[0])) * (to_px - from_px);
    const x_px = place_on(x_ticks, margin_px.left, width_px - margin_px.right);
    const y_px = place_on(y_ticks, height_px - margin_px.bottom, margin_px.top);
    pixel = (x, y) => [x_px(x), y_px(y)];
    const at = (x: number, y: number) => `${x_px(x).toFixed(1)} ${y_px(y).toFixed(1)}`;

    picture.setAttribute("width", String(width_px));
    picture.setAttribute("height", String(height_px));
    picture.replaceChildren();
    for (const [x, name] of words.x_names ?? x_ticks.map((tick): [number, string] => [tick, String(tick)])) {
      picture.append(svg("path", { class: "grid", d: `M${at(x, y_ticks[0])}V${margin_px.top}` }));
      picture.append(svg("text", { x: x_px(x), y: height_px - 24, "text-anchor": "middle" }, name));
    }
    for (const y of y_ticks) {
      picture.append(svg("path", { class: "grid", d: `M${at(x_ticks[0], y)}H${width_px - margin_px.right}` }));
      picture.append(svg("text", { x: margin_px.left - 6, y: y_px(y) + 4, "text-anchor": "end" }, String(y)));
    }
    for (const { at: value, label, vertical } of references) {
      const from = vertical ? at(value, y_ticks[0]) : at(x_ticks[0], value);
      picture.append(svg("path", { class: "reference", d: `M${from}${vertical ? `V${margin_px.top}` : `H${width_px - margin_px.right}`}` }));
      const place = vertical ? { x: x_px(value) + 4, y: margin_px.top + 10 } : { x: margin_px.left + 4, y: y_px(value) - 4 };
      picture.append(svg("text", { ...place, class: "reference" }, label));
    }
    picture.append(svg("text", { x: width_px - margin_px.right, y: height_px - 6, "text-anchor": "end" }, words.x_label));
    const middle_px = (height_px - margin_px.bottom) / 2;
    picture.append(svg("text", { x: 0, y: 0, "text-anchor": "middle", transform: `translate(11 ${middle_px}) rotate(-90)` }, words.y_label));
    for (const series of shown) {
      const index = all.indexOf(series);
      const style = `s${index % colors} ${series.mark} ${index >= colors ? "dashed" : ""}`;
      picture.append(svg("path", { class: `interval ${style}`, d: interval_path(series, at) }));
      picture.append(svg("path", { class: `values ${style}`, d: value_path(series, at) }));
    }
    picture.append(marker);
    choose(null);
  }

  function choose(point: [Series, number] | null): void {
    chosen = point;
    marker.setAttribute("visibility", point ? "visible" : "hidden");
    if (!point) return show_tip(tip, "", 0, 0);
    const [series, i] = point;
    const [x_px, y_px] = pixel(series.x[i], series.y[i]);
    marker.setAttribute("cx", String(x_px));
    marker.setAttribute("cy", String(y_px));
    const corner = picture.getBoundingClientRect();
    show_tip(tip, say_point(words, series, i), corner.left + x_px, corner.top + y_px);
  }

  picture.addEventListener("pointermove", (event) => {
    const corner = picture.getBoundingClientRect();
    let nearest: [Series, number] | null = null;
    let nearest_px = reach_px;
    for (const series of all) {
      for (let i = 0; i < series.x.length && !hidden.has(series); ++i) {
        const [x_px, y_px] = pixel(series.x[i], series.y[i]);
        const away_px = Math.hypot(x_px - (event.clientX - corner.left), y_px - (event.clientY - corner.top));
        if (away_px < nearest_px) [nearest, nearest_px] = [[series, i], away_px];
      }
    }
    choose(nearest);
  });
  picture.addEventListener("pointerleave", () => choose(null));
  picture.addEventListener("blur", () => choose(null));
  picture.addEventListener("keydown", (event) => {
    const [right, down] = { ArrowRight: [1, 0], ArrowLeft: [-1, 0], ArrowDown: [0, 1], ArrowUp: [0, -1] }[event.key] ?? [0, 0];
    const shown = all.filter((series) => !hidden.has(series) && series.x.length > 0);
    if ((right === 0 && down === 0) || shown.length === 0) return;
    event.preventDefault();
    const line = chosen ? shown.indexOf(chosen[0]) + down : 0;
    const series = shown[(line + shown.length) % shown.length];
    const next = chosen ? chosen[1] + right : 0;
    choose([series, Math.min(Math.max(next, 0), series.x.length - 1)]);
  });
  new ResizeObserver(draw).observe(box);
}
