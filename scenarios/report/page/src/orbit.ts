// Where the viewer's eye is: follow, orbit, onboard and top views, and the hands on mouse and screen.

import { Vec3 } from "ogl";
import { rotate, type Pose } from "./pose";
import type { Bounds } from "./shapes";
import type { CameraFact } from "./facts";

export type ViewName = "follow" | "orbit" | "onboard" | "top";

export interface Eye {
  position: Vec3;
  target: Vec3;
  up: Vec3;
  field_of_view_deg: number; // vertical
}

/// azimuth_rad: from the target to the eye; in the follow view it counts from the aircraft's heading.
export interface Orbit {
  view: ViewName;
  target: Vec3;
  azimuth_rad: number;
  elevation_rad: number;
  distance_m: number;
}

const wide_view_deg = 50;
const narrow_view_deg = 8; // from above: hardly any perspective, so that trunks stand upright
const follow_distance_m = 4.5;

function slope_of(view: ViewName): number {
  return Math.tan(((view === "top" ? narrow_view_deg : wide_view_deg) / 2) * (Math.PI / 180));
}

export function make_orbit(): Orbit {
  return { view: "follow", target: new Vec3(), azimuth_rad: Math.PI, elevation_rad: 0.3, distance_m: follow_distance_m };
}

/// Enters a view. Orbit begins where the eye already is; top shows the whole course.
export function enter_view(orbit: Orbit, view: ViewName, aircraft: Pose, heading_rad: number, bounds: Bounds, aspect: number): void {
  if (view === orbit.view && view !== "top" && view !== "follow") return;
  leave_top(orbit);
  if (view === "orbit" && orbit.view === "follow") {
    orbit.target = aircraft.position.clone();
    orbit.azimuth_rad += heading_rad;
  } else if (view === "orbit" && orbit.view === "onboard") {
    fit(orbit, bounds, aspect);
  } else if (view === "follow") {
    Object.assign(orbit, make_orbit());
  } else if (view === "top") {
    fit(orbit, bounds, aspect);
    orbit.azimuth_rad = -Math.PI / 2; // the course runs to the right
    orbit.elevation_rad = Math.PI / 2;
    orbit.distance_m *= slope_of("orbit") / slope_of("top");
  }
  orbit.view = view;
}

/// Orbits the whole course.
export function fit(orbit: Orbit, bounds: Bounds, aspect: number): void {
  const half_length_m = (bounds.high[0] - bounds.low[0]) / 2;
  const half_width_m = (bounds.high[1] - bounds.low[1]) / 2;
  const slope = slope_of("orbit");
  orbit.target.set((bounds.low[0] + bounds.high[0]) / 2, (bounds.low[1] + bounds.high[1]) / 2, 0);
  orbit.distance_m = 1.15 * Math.max(half_length_m / (slope * aspect), half_width_m / slope) + bounds.high[2];
  orbit.azimuth_rad = -Math.PI / 2 - 0.35;
  orbit.elevation_rad = 0.75;
  orbit.view = "orbit";
}

export function eye_of(orbit: Orbit, aircraft: Pose, heading_rad: number, camera: CameraFact | null | undefined): Eye {
  if (orbit.view === "onboard") return onboard_eye(aircraft, camera);
  const follows = orbit.view === "follow";
  const target = follows ? aircraft.position : orbit.target;
  const azimuth_rad = orbit.azimuth_rad + (follows ? heading_rad : 0);
  const [flat, high] = [Math.cos(orbit.elevation_rad), Math.sin(orbit.elevation_rad)];
  const [x, y] = [Math.cos(azimuth_rad), Math.sin(azimuth_rad)];
  const far_m = orbit.distance_m;
  return {
    position: new Vec3(target[0] + far_m * flat * x, target[1] + far_m * flat * y, Math.max(target[2] + far_m * high, 0.1)),
    target,
    up: new Vec3(-high * x, -high * y, flat), // never along the view, not even straight down
    field_of_view_deg: orbit.view === "top" ? narrow_view_deg : wide_view_deg,
  };
}

/// Through the left camera; where none is known, along the nose.
function onboard_eye(aircraft: Pose, camera: CameraFact | null | undefined): Eye {
  const matrix = camera?.T_body_camera ?? [0, 0, 1, 0.1, -1, 0, 0, 0, 0, -1, 0, 0.03, 0, 0, 0, 1];
  const column = (i: number) => rotate(aircraft, matrix[i], matrix[i + 4], matrix[i + 8]);
  const position = column(3).add(aircraft.position);
  return {
    position,
    target: column(2).add(position),
    up: column(1).negate(),
    field_of_view_deg: camera ? (2 * Math.atan(camera.height_px / 2 / camera.fy) * 180) / Math.PI : wide_view_deg,
  };
}

/// From the top view to the orbit view: as near as needed to see the same.
function leave_top(orbit: Orbit): void {
  if (orbit.view !== "top") return;
  orbit.distance_m *= slope_of("top") / slope_of("orbit");
  orbit.view = "orbit";
}

function turn(orbit: Orbit, right_px: number, down_px: number): void {
  leave_top(orbit);
  orbit.azimuth_rad -= right_px * 0.006;
  orbit.elevation_rad = Math.min(Math.max(orbit.elevation_rad + down_px * 0.006, -0.05), Math.PI / 2);
}

/// Moves the target in the picture's plane, so that what lies under the pointer stays there.
function pan(orbit: Orbit, eye: Eye, right_px: number, down_px: number, height_px: number): void {
  const metres_per_px = (2 * orbit.distance_m * slope_of(orbit.view)) / height_px;
  const [x, y] = [Math.sin(orbit.azimuth_rad), -Math.cos(orbit.azimuth_rad)]; // the picture's left
  for (let axis = 0; axis < 3; ++axis) {
    const left = axis === 0 ? x : axis === 1 ? y : 0;
    orbit.target[axis] += (left * right_px + eye.up[axis] * down_px) * metres_per_px;
  }
}

function zoom(orbit: Orbit, factor: number): void {
  orbit.distance_m = Math.min(Math.max(orbit.distance_m * factor, 0.8), 20000);
}

/// Drag turns, right or shift drag and two fingers pan, wheel and pinch zoom. begin_pan may leave the follow view.
export function attach_hands(canvas: HTMLCanvasElement, orbit: Orbit, eye: () => Eye, begin_pan: () => void, changed: () => void): void {
  const fingers = new Map<number, [number, number]>();
  const spread = (): number => {
    const [a, b] = [...fingers.values()];
    return Math.hypot(a[0] - b[0], a[1] - b[1]);
  };
  canvas.addEventListener("pointerdown", (event) => {
    canvas.setPointerCapture(event.pointerId);
    fingers.set(event.pointerId, [event.clientX, event.clientY]);
  });
  canvas.addEventListener("pointermove", (event) => {
    const last = fingers.get(event.pointerId);
    if (!last || orbit.view === "onboard") return;
    const [right_px, down_px] = [event.clientX - last[0], event.clientY - last[1]];
    const before = fingers.size === 2 ? spread() : 0;
    fingers.set(event.pointerId, [event.clientX, event.clientY]);
    if (fingers.size === 2) zoom(orbit, before / Math.max(spread(), 1));
    if (fingers.size === 2 || event.shiftKey || (event.buttons & 6) !== 0) {
      begin_pan();
      const share = fingers.size === 2 ? 0.5 : 1;
      pan(orbit, eye(), right_px * share, down_px * share, canvas.clientHeight);
    } else {
      turn(orbit, right_px, down_px);
    }
    changed();
  });
  for (const end of ["pointerup", "pointercancel"] as const) {
    canvas.addEventListener(end, (event) => fingers.delete(event.pointerId));
  }
  canvas.addEventListener("contextmenu", (event) => event.preventDefault());
  canvas.addEventListener("wheel", (event) => {
    event.preventDefault();
    if (orbit.view === "onboard") return;
    zoom(orbit, Math.exp(event.deltaY * (event.deltaMode === 1 ? 0.04 : 0.0015)));
    changed();
  }, { passive: false });
}
