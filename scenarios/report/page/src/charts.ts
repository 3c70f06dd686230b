// Charts on one time axis. A line stands at the present moment; a click or a drag seeks.

import uPlot from "uplot";
import type { Clock } from "./clock";
import { make, say_number, show_tip } from "./elements";
import { array_of, count_until, type Arrays, type Numbers } from "./data";
import type { ChartFact, EventFact, SeriesFact } from "./facts";

type Column = (number | null)[];

const plot_height_px = 118;
const legend_interval_ms = 100; // while playing: words change more slowly than lines move

/// A colour of the page's style.
function style_color(name: string): string {
  return getComputedStyle(document.documentElement).getPropertyValue(`--${name}`).trim();
}

/// NaN is a gap, which uPlot calls null.
function column_of(arrays: Arrays, name: string, component: number, components: number): Column {
  const numbers = array_of(arrays, name);
  const column: Column = new Array(Math.floor(numbers.length / components));
  for (let i = 0; i < column.length; ++i) {
    const value = numbers[i * components + component];
    column[i] = Number.isFinite(value) ? value : null;
  }
  return column;
}

interface Line {
  options: uPlot.Series;
  time: string;
  values: Column;
}

function lines_of(chart: ChartFact, arrays: Arrays, components: Map<string, number>): Line[] {
  const words = chart.words;
  const say = (_: uPlot, value: number | null) => (words ? words[value ?? -1] ?? "–" : say_number(value, chart.unit));
  const line = (name: string, array: string, component: number, time: string, options: Partial<uPlot.Series>): Line => ({
    options: { label: name, value: say, points: { show: false }, width: 1.5, pxAlign: 0, ...options },
    time,
    values: column_of(arrays, array, component, components.get(array) ?? 1),
  });
  const lines = chart.series.map((series: SeriesFact) =>
    line(series.name, series.array, series.component ?? 0, series.time ?? "t", {
      stroke: () => style_color(series.color),
      ...(words ? { paths: uPlot.paths.stepped!({ align: 1 }) } : {}),
    }));
  for (const band of chart.bands ?? []) { // two lines without ink; the first one's legend says both values
    const edge = { width: 0, stroke: "transparent" };
    lines.push(line(`${band.name}, lower`, band.lower, 0, "t", { ...edge, class: "edge" }));
    const lower = lines[lines.length - 1].values;
    const both = (_: uPlot, value: number | null, __: number, row: number | null) =>
      `${say_number(lower[row ?? -1], "")} … ${say_number(value, chart.unit)}`;
    lines.push(line(band.name, band.upper, 0, "t", { ...edge, value: both, class: "band" }));
  }
  return lines.filter((each) => each.values.some((value) => value !== null) && array_of(arrays, each.time).length > 0);
}

/// One table with a common time column. Lines that have a time of their own are merged into it.
function join_lines(lines: Line[], arrays: Arrays): uPlot.AlignedData {
  const times = [...new Set(lines.map((line) => line.time))];
  const tables = times.map((time) => {
    const column = Array.from(array_of(arrays, time));
    const own = lines.filter((line) => line.time === time).map((line) => line.values.slice(0, column.length));
    return [column, ...own] as uPlot.AlignedData;
  });
  lines.sort((a, b) => times.indexOf(a.time) - times.indexOf(b.time)); // join puts table after table
  return tables.length === 1 ? tables[0] : uPlot.join(tables);
}

/// Between which values most of a line lies from the launch to 2 s before the end: what is usual in this flight.
function say_usual(line: Line, times: Numbers, unit: string, from_s: number, to_s: number): string {
  const values = line.values.filter((value, i): value is number => value !== null && times[i] >= from_s && times[i] <= to_s);
  if (values.length < 20) return "";
  values.sort((a, b) => a - b);
  const at = (share: number) => values[Math.round(share * (values.length - 1))];
  return `usually ${say_number(at(0.05), "")} … ${say_number(at(0.95), unit)}`;
}

/// The range of the values and limits with a margin. A line that does not move lies in the middle.
function value_range(chart: ChartFact, low: number | null, high: number | null): [number, number] {
  if (chart.words) return [-0.5, chart.words.length - 0.5];
  const limits = (chart.limits ?? []).map((limit) => limit.value);
  const minimum = Math.min(low ?? Infinity, ...limits);
  const maximum = Math.max(high ?? -Infinity, ...limits);
  if (!Number.isFinite(minimum) || !Number.isFinite(maximum)) return [0, 1];
  const margin = maximum > minimum ? 0.07 * (maximum - minimum) : Math.max(Math.abs(maximum) * 0.1, 0.5);
  return [minimum - margin, maximum + margin];
}

function draw_marks(plot: uPlot, chart: ChartFact, events: EventFact[]): void {
  const { ctx, bbox } = plot;
  const pixel = uPlot.pxRatio;
  ctx.save();
  ctx.beginPath();
  ctx.rect(bbox.left, bbox.top, bbox.width, bbox.height);
  ctx.clip();
  ctx.lineWidth = pixel;
  ctx.font = `${10 * pixel}px system-ui, sans-serif`;
  ctx.textAlign = "left";
  ctx.textBaseline = "alphabetic";
  for (const event of events) {
    const x = plot.valToPos(event.t_s, "x", true);
    ctx.strokeStyle = style_color(`event-${event.kind}`);
    ctx.globalAlpha = 0.6;
    ctx.beginPath();
    ctx.moveTo(x, bbox.top);
    ctx.lineTo(x, bbox.top + bbox.height);
    ctx.stroke();
  }
  ctx.globalAlpha = 1;
  ctx.setLineDash([5 * pixel, 4 * pixel]);
  ctx.strokeStyle = ctx.fillStyle = style_color("limit");
  for (const limit of chart.limits ?? []) {
    const y = plot.valToPos(limit.value, "y", true);
    ctx.beginPath();
    ctx.moveTo(bbox.left, y);
    ctx.lineTo(bbox.left + bbox.width, y);
    ctx.stroke();
    const below = y - bbox.top < 14 * pixel;
    ctx.fillText(limit.name, bbox.left + 4 * pixel, y + (below ? 11 : -3) * pixel);
  }
  ctx.restore();
}

function axes_of(chart: ChartFact): uPlot.Axis[] {
  const common = {
    stroke: () => style_color("quiet"),
    grid: { stroke: () => style_color("line"), width: 1 },
    ticks: { show: false },
    font: "11px system-ui, sans-serif",
    gap: 3,
  };
  const words = chart.words;
  const worded = words && { splits: () => words.map((_, i) => i), values: () => words };
  return [{ ...common, size: 20 }, { ...common, size: 56, space: 24, ...(worded || {}) }];
}

export interface Charts {
  update(): void; // the clock moved
  redraw(): void; // the colours changed
  show(begin_s: number, end_s: number): void;
  close(): void;
}

/// Draws all charts into `place`. `tip` shows the event under the pointer.
export function add_charts(place: HTMLElement, tip: HTMLElement, facts: ChartFact[], events: EventFact[], arrays: Arrays,
                           components: Map<string, number>, clock: Clock): Charts {
  const plots: { plot: uPlot; now: HTMLElement }[] = [];
  let window_s: [number, number] = [clock.begin_s, Math.max(clock.end_s, clock.begin_s + 0.01)];
  const in_charts = () => plots.some(({ plot }) => plot.over.matches(":hover"));

  function seek_by_pointer(plot: uPlot): void {
    const seek = (event: PointerEvent) => clock.seek(plot.posToVal(event.clientX - plot.over.getBoundingClientRect().left, "x"));
    plot.over.addEventListener("pointerdown", (event) => {
      if (event.button !== 0) return;
      plot.over.setPointerCapture(event.pointerId);
      seek(event);
    });
    plot.over.addEventListener("pointermove", (event) => {
      if (event.buttons & 1) seek(event);
      tell_event(plot, event);
    });
    plot.over.addEventListener("pointerleave", () => {
      tip.hidden = true;
      tell_values();
    });
  }

  function tell_event(plot: uPlot, pointer: PointerEvent): void {
    const x = pointer.clientX - plot.over.getBoundingClientRect().left;
    const near = events.filter((event) => Math.abs(plot.valToPos(event.t_s, "x") - x) < 5);
    const text = near.map((event) => `${event.t_s.toFixed(2)} s  ${event.text}`).join("\n");
    show_tip(tip, text, pointer.clientX, pointer.clientY);
  }

  function tell_values(): void {
    for (const { plot } of plots) {
      const row = Math.max(count_until(plot.data[0] as never, clock.time_s + 1e-6) - 1, 0);
      plot.setLegend({ idxs: plot.data.map((column, i) => (i === 0 ? row : last_known(column as Column, row))) }, false);
    }
  }

  for (const fact of facts) {
    const box = place.appendChild(make("figure", "", "chart"));
    const heading = box.appendChild(make("figcaption", fact.title));
    if (fact.unit && fact.unit !== "1") heading.append(make("span", fact.unit));
    const lines = lines_of(fact, arrays, components);
    if (lines.length === 0) {
      box.append(make("p", "No values in this flight.", "quiet"));
      continue;
    }
    if (!fact.words) {
      const launch_s = events.find((event) => event.kind === "launch")?.t_s ?? clock.begin_s;
      const usual = say_usual(lines[0], array_of(arrays, lines[0].time), fact.unit, launch_s, clock.end_s - 2);
      heading.append(make("span", usual, "usual"));
    }
    const data = join_lines(lines, arrays);
    const row_of = (label: string) => lines.findIndex((line) => line.options.label === label) + 1;
    const bands = (fact.bands ?? []).map((band): uPlot.Band => ({
      series: [row_of(band.name), row_of(`${band.name}, lower`)],
      fill: () => style_color("band"),
    })).filter((band) => band.series[0] > 0 && band.series[1] > 0);
    const plot = new uPlot({
      width: Math.max(place.clientWidth - 4, 200),
      height: plot_height_px,
      padding: [6, 8, 0, 0],
      scales: {
        x: { time: false, range: () => window_s },
        y: { range: (_, low, high) => value_range(fact, low, high) },
      },
      axes: axes_of(fact),
      series: [{}, ...lines.map((line) => line.options)],
      bands,
      legend: { mount: (_, legend) => heading.append(legend) },
      cursor: { sync: { key: "time" }, drag: { x: false, y: false }, y: false, points: { size: 5 } },
      hooks: { drawAxes: [(drawn) => draw_marks(drawn, fact, events)] },
    }, data, box);
    plot.over.style.touchAction = "pan-y";
    const now = plot.over.appendChild(make("div", "", "now"));
    plots.push({ plot, now });
    seek_by_pointer(plot);
  }

  const sizes = new ResizeObserver(() => {
    const width = Math.max(place.clientWidth - 4, 200);
    for (const { plot } of plots) if (plot.width !== width) plot.setSize({ width, height: plot_height_px });
    place_now();
  });
  sizes.observe(place);

  function place_now(): void {
    for (const { plot, now } of plots) {
      const x = plot.valToPos(clock.time_s, "x");
      now.style.transform = `translateX(${x}px)`;
      now.hidden = x < -1 || x > plot.over.clientWidth + 1;
    }
  }

  let told_ms = 0;
  return {
    update() {
      place_now();
      const now_ms = performance.now();
      if (in_charts() || (clock.playing && now_ms - told_ms < legend_interval_ms)) return;
      told_ms = now_ms;
      tell_values();
    },
    close() {
      sizes.disconnect();
      for (const { plot } of plots) plot.destroy();
    },
    redraw() {
      for (const { plot } of plots) plot.redraw(false, true);
    },
    show(begin_s, end_s) {
      window_s = [begin_s, Math.max(end_s, begin_s + 0.01)];
      for (const { plot } of plots) plot.setScale("x", { min: window_s[0], max: window_s[1] });
      place_now();
    },
  };
}

/// A joined table leaves cells open where another line has a value: the value before counts.
function last_known(column: Column, row: number): number {
  while (row > 0 && column[row] === undefined) --row;
  return row;
}
