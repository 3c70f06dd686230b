// Shapes as typed arrays for the graphics card. Built once, before the first picture.

import { make_pose, pose_at, rotate } from "./pose";
import type { CameraFact, CourseFact } from "./facts";

export type Attributes = Record<string, { size?: number; data: Float32Array | Uint16Array | Uint32Array; instanced?: number }>;

export interface Bounds {
  low: number[];
  high: number[];
}

/// Lines that are wider than a pixel: two triangles to a segment, widened by the vertex shader.
/// pairs: indices of points, two to a segment. times_s: one to a point, or none.
export function thick_lines(points: ArrayLike<number>, pairs: ArrayLike<number>, times_s?: ArrayLike<number>): Attributes {
  const segments = pairs.length / 2;
  const position = new Float32Array(segments * 12);
  const other = new Float32Array(segments * 12);
  const side = new Float32Array(segments * 4);
  const time_s = new Float32Array(segments * 4);
  const index = new Uint32Array(segments * 6);
  const sides = [-1, 1, 1, -1]; // the direction turns round at the far end, and with it the side
  const triangles = [0, 1, 2, 2, 1, 3];
  for (let segment = 0; segment < segments; ++segment) {
    for (let corner = 0; corner < 4; ++corner) {
      const vertex = segment * 4 + corner;
      const here = pairs[segment * 2 + (corner < 2 ? 0 : 1)];
      const there = pairs[segment * 2 + (corner < 2 ? 1 : 0)];
      for (let axis = 0; axis < 3; ++axis) {
        position[vertex * 3 + axis] = points[here * 3 + axis];
        other[vertex * 3 + axis] = points[there * 3 + axis];
      }
      side[vertex] = sides[corner];
      time_s[vertex] = times_s ? times_s[here] : -1e9;
    }
    for (let i = 0; i < 6; ++i) index[segment * 6 + i] = segment * 4 + triangles[i];
  }
  return {
    position: { size: 3, data: position }, other: { size: 3, data: other }, side: { data: side }, time_s: { data: time_s }, index: { data: index },
  };
}

/// Boxes, given by the eight corners of each; `chosen` the numbers of those that are wanted.
export function boxes(corners: Float32Array, chosen: number[]): Attributes {
  const position = new Float32Array(chosen.length * 24);
  const index = new Uint32Array(chosen.length * 36);
  const faces = [0, 1, 3, 0, 3, 2, 4, 7, 5, 4, 6, 7, 0, 4, 5, 0, 5, 1, 2, 3, 7, 2, 7, 6, 0, 2, 6, 0, 6, 4, 1, 5, 7, 1, 7, 3];
  chosen.forEach((number, box) => {
    position.set(corners.subarray(number * 24, number * 24 + 24), box * 24);
    faces.forEach((vertex, i) => (index[box * 36 + i] = box * 8 + vertex));
  });
  return { position: { size: 3, data: position }, index: { data: index } };
}

/// Pairs that join every `stride`-th of `count` points, the last one included.
export function chain(count: number, stride: number): number[] {
  const pairs: number[] = [];
  for (let i = 0; i + 1 < count; i += stride) pairs.push(i, Math.min(i + stride, count - 1));
  return pairs;
}

/// Where the two wing tips were at each moment: vertices of a triangle strip.
export function swept_wing(times: Float32Array, poses: Float32Array, tips: Float32Array): Attributes {
  const position = new Float32Array(times.length * 6);
  const time_s = new Float32Array(times.length * 2);
  const pose = make_pose();
  for (let i = 0; i < times.length; ++i) {
    pose_at(times, poses, times[i], pose);
    for (const k of [0, 3]) position.set(rotate(pose, tips[k], tips[k + 1], tips[k + 2]).add(pose.position), i * 6 + k);
    time_s[i * 2] = time_s[i * 2 + 1] = times[i];
  }
  return { position: { size: 3, data: position }, time_s: { data: time_s } };
}

/// One trunk from z = 0 to z = 1 with radius 1 and a lid at the top. 3 * sides - 2 triangles.
export function unit_trunk(sides: number): Attributes {
  const position: number[] = [];
  const index: number[] = [];
  for (let i = 0; i < sides; ++i) {
    const angle = (2 * Math.PI * i) / sides;
    position.push(Math.cos(angle), Math.sin(angle), 0, Math.cos(angle), Math.sin(angle), 1);
    const next = (i + 1) % sides;
    index.push(2 * i, 2 * next, 2 * i + 1, 2 * i + 1, 2 * next, 2 * next + 1);
    if (i > 0 && next > 0) index.push(1, 2 * i + 1, 2 * next + 1);
  }
  return { position: { size: 3, data: new Float32Array(position) }, index: { data: new Uint16Array(index) } };
}

/// Lines on the ground, spacing_m apart.
export function ground_grid(bounds: Bounds, spacing_m: number): Attributes {
  const points: number[] = [];
  const [x0, y0] = [bounds.low[0], bounds.low[1]];
  const [x1, y1] = [bounds.high[0], bounds.high[1]];
  for (let x = x0; x <= x1 + 0.01; x += spacing_m) points.push(x, y0, 0, x, y1, 0);
  for (let y = y0; y <= y1 + 0.01; y += spacing_m) points.push(x0, y, 0, x1, y, 0);
  return { position: { size: 3, data: new Float32Array(points) } };
}

/// The sides on the ground, the goal plane as a frame, and the altitude band across it.
export function course_limits(course: CourseFact, start_x_m: number): Attributes {
  const goal = course.goal_x_m;
  const half = course.half_width_m;
  const points: number[] = [];
  const line = (a: number[], b: number[]) => points.push(...a, ...b);
  for (const y of [-half, half]) {
    line([start_x_m, y, 0], [goal, y, 0]);
    line([goal, y, 0], [goal, y, course.maximum_altitude_m]);
  }
  for (const z of [0, course.minimum_altitude_m, course.maximum_altitude_m]) line([goal, -half, z], [goal, half, z]);
  return thick_lines(points, [...Array(points.length / 3).keys()]);
}

/// What both cameras see, in the body frame: edges from where their views meet, rectangles at depths_m.
export function camera_frusta(camera: CameraFact): Attributes {
  const matrix = camera.T_body_camera;
  const points: number[] = [];
  const corners = (depth_m: number): void => {
    const left = camera.baseline_m - (camera.cx / camera.fx) * depth_m; // the right camera's left edge
    const right = ((camera.width_px - camera.cx) / camera.fx) * depth_m;
    const top = (-camera.cy / camera.fy) * depth_m;
    const bottom = ((camera.height_px - camera.cy) / camera.fy) * depth_m;
    for (const [x, y] of [[left, top], [right, top], [right, bottom], [left, bottom]]) {
      for (let row = 0; row < 3; ++row) {
        const m = row * 4;
        points.push(matrix[m] * x + matrix[m + 1] * y + matrix[m + 2] * depth_m + matrix[m + 3]);
      }
    }
  };
  corners((camera.baseline_m * camera.fx) / camera.width_px); // here the common view begins, one line high
  const pairs: number[] = [];
  for (const depth_m of [...camera.depths_m].sort((a, b) => a - b)) {
    const first = points.length / 3;
    corners(depth_m);
    for (let i = 0; i < 4; ++i) pairs.push(first + i, first + ((i + 1) % 4));
    for (let i = 0; i < 4; ++i) pairs.push(first - 4 + i, first + i);
  }
  return thick_lines(points, pairs);
}

/// A box around `center`, half_size from there.
export function box(center: ArrayLike<number>, half_size: ArrayLike<number>): Attributes {
  const position: number[] = [];
  for (let corner = 0; corner < 8; ++corner) {
    for (let axis = 0; axis < 3; ++axis) position.push(center[axis] + ((corner >> axis) & 1 ? 1 : -1) * half_size[axis]);
  }
  const index = [0, 1, 2, 2, 1, 3, 4, 5, 6, 6, 5, 7, 0, 1, 4, 4, 1, 5, 2, 3, 6, 6, 3, 7, 0, 2, 4, 4, 2, 6, 1, 3, 5, 5, 3, 7];
  return { position: { size: 3, data: new Float32Array(position) }, index: { data: new Uint16Array(index) } };
}

/// Three circles: a mark that is seen from every side.
export function impact_mark(radius_m: number): Attributes {
  const points: number[] = [];
  const pairs: number[] = [];
  for (let i = 0; i < 60; ++i) {
    const circle = Math.floor(i / 20);
    const point = [0, 0, 0];
    point[circle] = radius_m * Math.cos((i * Math.PI) / 10);
    point[(circle + 1) % 3] = radius_m * Math.sin((i * Math.PI) / 10);
    points.push(...point);
    pairs.push(i, circle * 20 + ((i + 1) % 20));
  }
  return thick_lines(points, pairs);
}
