// Poses (position, quaternion x y z w: body to world) between recorded moments.

import { Quat, Vec3 } from "ogl";
import { count_until } from "./data";

export interface Pose {
  position: Vec3;
  quaternion: Quat;
}

export function make_pose(): Pose {
  return { position: new Vec3(), quaternion: new Quat() };
}

const next = make_pose();

/// Writes the pose at a moment into `out`. False, writing nothing, where none is known.
export function pose_at(times: Float32Array, poses: Float32Array, time_s: number, out: Pose): boolean {
  const count = Math.min(times.length, poses.length / 7);
  if (count === 0) return false;
  const first = Math.min(Math.max(count_until(times, time_s) - 1, 0), count - 1);
  const second = Math.min(first + 1, count - 1);
  if (Number.isNaN(poses[first * 7])) return false;
  out.position.fromArray(poses, first * 7);
  out.quaternion.fromArray(poses as never, first * 7 + 3);
  if (!(times[second] > times[first]) || Number.isNaN(poses[second * 7])) return true;
  const part = Math.min(Math.max((time_s - times[first]) / (times[second] - times[first]), 0), 1);
  out.position.lerp(next.position.fromArray(poses, second * 7), part);
  out.quaternion.slerp(next.quaternion.fromArray(poses as never, second * 7 + 3), part);
  return true;
}

/// Writes into `out` the rigid motion that carries what lies at `from` to the same place at `to`.
export function motion_between(from: Pose, to: Pose, out: Pose): void {
  out.quaternion.copy(from.quaternion).inverse();
  out.quaternion.multiply(to.quaternion, out.quaternion);
  out.position.copy(from.position).applyQuaternion(out.quaternion).negate().add(to.position);
}

/// A vector of the body in the world's axes.
export function rotate(pose: Pose, x: number, y: number, z: number): Vec3 {
  return new Vec3(x, y, z).applyQuaternion(pose.quaternion);
}
