// The facts of the pages, as the C++ writes them. Names end in their units.

export interface ArrayFact {
  name: string;
  type: "f32" | "u32" | "i16" | "u16" | "u8";
  scale?: number; // of an i16: the value is stored * scale, and -32768 is NaN
  components: number;
  count: number; // tuples
  offset: number; // bytes into the decoded buffer
}

type SeriesColor = "truth" | "estimate" | "command" | "alert" | "other";

export interface SeriesFact {
  name: string;
  array: string;
  component?: number;
  color: SeriesColor;
  time?: string; // an array of seconds; "t" where absent
}

export interface ChartFact {
  title: string;
  unit: string;
  series: SeriesFact[];
  bands?: { name: string; lower: string; upper: string }[];
  limits?: { name: string; value: number }[];
  words?: string[] | null; // a step chart: values are indices into these
}

export interface EventFact {
  t_s: number;
  kind: "launch" | "in_view" | "detected" | "forgotten" | "blind" | "estimate" | "fallback" | "fault" | "outcome";
  text: string;
}

export interface CameraFact {
  width_px: number; height_px: number;
  fx: number; fy: number; cx: number; cy: number;
  T_body_camera: number[]; // 4 x 4, row major
  depths_m: number[];
  baseline_m: number;
}

export interface CourseFact {
  goal_x_m: number; half_width_m: number;
  minimum_altitude_m: number; maximum_altitude_m: number; cruise_altitude_m: number;
}

interface PageFacts {
  title: string;
  program?: string;
  warning?: string;
  sentence?: string;
  sections?: SectionFact[];
  arrays?: ArrayFact[];
}

export interface FlightFacts extends PageFacts {
  kind: "flight";
  program: string;
  outcome: "goal" | "collision" | "ground" | "out_of_bounds" | "time" | "aborted";
  sentence: string;
  story?: string[];
  command?: string;
  scenario?: string;
  digest?: string;
  result?: [string, string][];
  keys?: [string, string, string][];
  t_end_s: number;
  t_launch_s?: number;
  course?: CourseFact | null;
  obstacle_kinds?: string[]; // what the numbers of the array obstacle_kinds mean
  touched_name?: string;
  touched?: number | null;
  impact?: { position: [number, number, number]; part: string } | null;
  camera?: CameraFact | null;
  charts?: ChartFact[];
  events?: EventFact[];
  decimation?: string[];
  film?: { times: string } | null;
}

export interface Condition {
  name: string;
  label: string;
  keys: Record<string, string>; // grid keys and the values of this condition
  flights: number;
  flown: number;
  goals: number;
  share: number | null; // goals of the flown ones, and its 95 % interval; null where none was flown
  lower: number | null;
  upper: number | null;
  between_crashes_km: string; // "1.2 (0.6 to 2.8)", "> 4.0" without a crash
}

export interface GateFact {
  verdict: "passes" | "fails" | "undecided";
  title: string;
  baseline: string;
  candidate: string;
  lines?: string[];
  pairs?: [string, string | number, string, string][]; // condition, seed, outcome of the baseline, of the candidate
}

export interface CampaignFacts extends PageFacts {
  kind: "campaign";
  conditions: Condition[];
  grid_keys?: string[];
  outcomes: string[];
  columns?: { name: string; label: string; unit: string }[];
  survival?: { condition: number; array: string }[];
  rows: { ids: string[]; seeds: string[]; reasons: string[]; touched: string[]; commands: string[] };
  tracks?: Record<string, string>;
  gate?: GateFact | null;
}

export interface PlotFact {
  x_label: string;
  y_label: string;
  series: { name: string; x: string; y: string; lower?: string; upper?: string; mark: Mark; labels?: string[] }[];
  references?: Reference[];
  x_names?: [number, string][]; // of places along x, in the place of numbers
}

/// A line across the plot at one value.
export interface Reference {
  at: number;
  label: string;
  vertical: boolean;
}

export type Mark = "line" | "points" | "steps";

export interface SectionFact {
  title: string;
  text?: string;
  bars?: { name: string; parts: [string, number][] }[];
  plot?: PlotFact | null;
  table?: { columns: { label: string; unit?: string }[]; rows: (string | number | null)[][] } | null;
  pictures?: { caption: string; block: string; type: string }[];
}

export interface SheetFacts extends PageFacts {
  kind: "sheet";
}
