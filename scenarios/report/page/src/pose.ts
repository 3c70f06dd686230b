// Poses (position, quaternion x y z w: body to world) between recorded moments.

import { count_until } from "./data";

export type Vector = [number, number, number];

export interface Pose {
  position: Vector;
  quaternion: [number, number, number, number];
}

export function make_pose(): Pose {
  return { position: [0, 0, 0], quaternion: [0, 0, 0, 1] };
}

/// Writes the pose at a moment into `out`. False, writing nothing, where none is known.
export function pose_at(times: Float32Array, poses: Float32Array, time_s: number, out: Pose): boolean {
  const count = Math.min(times.length, poses.length / 7);
  if (count === 0) return false;
  const first = Math.min(Math.max(count_until(times, time_s) - 1, 0), count - 1);
  const second = Math.min(first + 1, count - 1);
  const span_s = times[second] - times[first];
  const part = span_s > 0 ? Math.min(Math.max((time_s - times[first]) / span_s, 0), 1) : 0;
  const a = first * 7;
  const b = second * 7;
  const known = Number.isFinite(poses[a]) && Number.isFinite(poses[b]);
  if (!Number.isFinite(poses[a])) return false;
  const weight = known ? part : 0;
  for (let i = 0; i < 3; ++i) {
    out.position[i] = poses[a + i] + (weight > 0 ? weight * (poses[b + i] - poses[a + i]) : 0);
  }
  // q and -q are the same attitude: take the nearer one, blend and normalise.
  let dot = 0;
  for (let i = 3; i < 7; ++i) dot += poses[a + i] * poses[b + i];
  const sign = dot < 0 ? -1 : 1;
  let length = 0;
  for (let i = 0; i < 4; ++i) {
    const value = (1 - weight) * poses[a + 3 + i] + (weight > 0 ? weight * sign * poses[b + 3 + i] : 0);
    out.quaternion[i] = value;
    length += value * value;
  }
  const scale = length > 0 ? 1 / Math.sqrt(length) : 1;
  for (let i = 0; i < 4; ++i) out.quaternion[i] *= scale;
  return true;
}

/// A vector of the body in the world's axes.
export function rotate(quaternion: Pose["quaternion"], v: Vector): Vector {
  const [x, y, z, w] = quaternion;
  const cx = y * v[2] - z * v[1] + w * v[0];
  const cy = z * v[0] - x * v[2] + w * v[1];
  const cz = x * v[1] - y * v[0] + w * v[2];
  return [v[0] + 2 * (y * cz - z * cy), v[1] + 2 * (z * cx - x * cz), v[2] + 2 * (x * cy - y * cx)];
}

/// A point of the body in the world.
export function transform(pose: Pose, point: Vector): Vector {
  const turned = rotate(pose.quaternion, point);
  return [turned[0] + pose.position[0], turned[1] + pose.position[1], turned[2] + pose.position[2]];
}
