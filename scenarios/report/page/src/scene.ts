// The replay in three dimensions. Everything is on the graphics card before the first picture; a picture only sets
// numbers, ranges and two poses.

import { Camera, Geometry, Mesh, Program, Renderer, Transform, Vec3, type OGLRenderingContext } from "ogl";
import { array_of, count_until, floats_of, type Arrays } from "./data";
import type { FlightFacts } from "./facts";
import { attach_hands, enter_view, eye_of, fit, make_orbit, type Eye, type Orbit, type ViewName } from "./orbit";
import { make_pose, motion_between, pose_at, type Pose } from "./pose";
import * as shaders from "./shaders";
import * as shapes from "./shapes";

export type Layer = "estimate" | "map" | "hits" | "plan" | "frusta";
type Layers = Record<Layer, boolean>;

const trail_length_s = 2;
const hits_shown_s = 0.1;
const fallback_origin = 3;
const trunk_triangles = 24000; // of the 50,000 a picture may have
const path_segments = 3000;

type Uniforms = Record<string, { value: unknown }>;
type Shader = { vertex: string; fragment: string };

let in_software: boolean | undefined; // asked once: the graphics card stays

/// There, smooth edges would cost two thirds of the speed. Throws where there is no WebGL2. A context cannot change
/// its mind about smooth edges: so this asks one of its own, and gives it back.
function draws_in_software(): boolean {
  if (in_software !== undefined) return in_software;
  const gl = document.createElement("canvas").getContext("webgl2");
  if (!gl) throw new Error("no WebGL2");
  let name = String(gl.getParameter(gl.RENDERER));
  if (name.includes("WebKit")) { // Chromium says the true name only here, and Firefox warns when asked here
    const details = gl.getExtension("WEBGL_debug_renderer_info");
    if (details) name = String(gl.getParameter(details.UNMASKED_RENDERER_WEBGL));
  }
  gl.getExtension("WEBGL_lose_context")?.loseContext();
  return in_software = /swiftshader|llvmpipe|software|basic render/i.test(name);
}

export class Replay {
  readonly layers: Layers = { estimate: false, map: true, hits: true, plan: true, frusta: true };
  readonly orbit: Orbit = make_orbit();
  private readonly renderer: Renderer;
  private readonly gl: OGLRenderingContext;
  private readonly camera: Camera;
  private readonly scene = new Transform();
  private readonly parts: Record<string, Mesh | undefined> = {};
  private readonly bounds: shapes.Bounds;
  private readonly times: Float32Array;
  private readonly truth: Float32Array;
  private readonly estimate: Float32Array;
  private readonly pose = make_pose();
  private readonly estimate_pose = make_pose();
  private readonly earlier = make_pose();
  private readonly remembered = make_pose(); // carries the estimate's world to where the aircraft truly is
  private readonly plan_segments: Uint32Array; // first segment of each plan; one more for the end
  private readonly plan_colors: number[][] = [];
  private readonly shared: Uniforms = {
    background: { value: [0, 0, 0] },
    fade_m: { value: [60, 160] },
    now_s: { value: 0 },
    viewport_px: { value: [1, 1] },
    pixels_per_radian: { value: 500 },
    see_through_m: { value: 0 },
    alert_color: { value: [1, 0, 0] },
  };
  private readonly colored: { uniform: { value: unknown }; name: string }[] = [];
  private time_s = 0;
  private eye: Eye;

  /// Throws where there is no WebGL2.
  constructor(readonly canvas: HTMLCanvasElement, private readonly facts: FlightFacts, private readonly arrays: Arrays, changed: () => void) {
    const smooth = !draws_in_software();
    const dpr = smooth ? Math.min(window.devicePixelRatio, 2) : 1;
    this.renderer = new Renderer({ canvas, dpr, antialias: smooth, width: canvas.clientWidth, height: canvas.clientHeight });
    canvas.style.width = canvas.style.height = ""; // the layout decides, not ogl
    this.gl = this.renderer.gl;
    this.camera = new Camera(this.gl, { near: 0.05, far: 4000, fov: 50 });
    this.times = floats_of(arrays, "t");
    this.truth = floats_of(arrays, "truth");
    this.estimate = floats_of(arrays, "estimate");
    this.bounds = this.find_bounds();
    this.plan_segments = this.count_plan_segments();
    this.add_ground();
    this.add_trunks();
    this.add_plans_and_points();
    this.add_flight();
    this.add_crowns();
    this.eye = eye_of(this.orbit, this.pose, 0, facts.camera);
    attach_hands(canvas, this.orbit, () => this.eye, () => {
      if (this.orbit.view === "follow") this.set_view("orbit");
    }, changed);
  }

  private find_bounds(): shapes.Bounds {
    const low = [-2, -5, 0];
    const high = [10, 5, 5];
    const add = (numbers: ArrayLike<number>, stride: number, used: number) => {
      for (let i = 0; i + used <= numbers.length; i += stride) {
        for (let k = 0; k < used; ++k) {
          if (numbers[i + k] < low[k % 3]) low[k % 3] = numbers[i + k];
          if (numbers[i + k] > high[k % 3]) high[k % 3] = numbers[i + k];
        }
      }
    };
    add(array_of(this.arrays, "obstacles"), 7, 6);
    add(this.truth, 7, 3);
    const course = this.facts.course;
    if (course) add([course.goal_x_m, course.half_width_m, 0, 0, -course.half_width_m, 0], 3, 3);
    return { low, high };
  }

  private program(shader: Shader, own: Uniforms, color: string, more: Partial<Program> = {}): Program {
    const uniforms: Uniforms = { ...this.shared, color: { value: [1, 1, 1] }, opacity: { value: 1 }, ...own };
    this.colored.push({ uniform: uniforms.color, name: color });
    return new Program(this.gl, { ...shader, uniforms, cullFace: false as never, ...more });
  }

  /// Meshes are drawn in the order in which they are added. No mesh where there is nothing to draw.
  private add(attributes: shapes.Attributes, program: Program, mode: number = this.gl.TRIANGLES, parent: Transform = this.scene): Mesh | undefined {
    if (Object.values(attributes).some((attribute) => attribute.data.length === 0)) return undefined;
    const mesh = new Mesh(this.gl, { geometry: new Geometry(this.gl, attributes as never), program, mode });
    mesh.setParent(parent);
    return mesh;
  }

  private add_lines(lines: shapes.Attributes, color: string, width_px: number, opacity = 1): Mesh | undefined {
    const own = { width_px: { value: width_px }, opacity: { value: opacity } };
    const program = this.program(shaders.line, own, color, { transparent: opacity < 1, depthWrite: opacity === 1 });
    return this.add(lines, program);
  }

  private add_ground(): void {
    const length_m = this.bounds.high[0] - this.bounds.low[0];
    const spacing_m = length_m > 400 ? 25 : length_m > 150 ? 10 : 5;
    const snap = (value: number, margin: number) => Math.round(value / spacing_m + margin) * spacing_m;
    const ground: shapes.Bounds = {
      low: [snap(this.bounds.low[0], -2), snap(this.bounds.low[1], -2), 0],
      high: [snap(this.bounds.high[0], 2), snap(this.bounds.high[1], 2), 0],
    };
    const [x0, y0, x1, y1] = [ground.low[0], ground.low[1], ground.high[0], ground.high[1]];
    const corners = new Float32Array([x0, y0, 0, x1, y0, 0, x0, y1, 0, x1, y1, 0]);
    const flat = { shading: { value: 0 } };
    const behind_all = { depthTest: false, depthWrite: false };
    const colored = (color: string) => this.program(shaders.surface, flat, color, behind_all);
    this.parts.ground = this.add({ position: { size: 3, data: corners } }, colored("ground"), this.gl.TRIANGLE_STRIP);
    this.parts.grid = this.add(shapes.ground_grid(ground, spacing_m), colored("grid"), this.gl.LINES);
    if (this.facts.course) {
      this.parts.limits = this.add_lines(shapes.course_limits(this.facts.course, Math.min(this.bounds.low[0], 0)), "limit", 1.5);
    }
  }

  /// Cylinders between two points; `numbers` are theirs in the array of obstacles, from, to and radius each.
  private add_round(values: Float32Array, numbers: number[], program: Program): Mesh | undefined {
    const count = numbers.length;
    const [from, to, radius_m, touched] = [3, 3, 1, 1].map((size) => new Float32Array(count * size));
    numbers.forEach((number, i) => {
      from.set(values.subarray(number * 7, number * 7 + 3), i * 3);
      to.set(values.subarray(number * 7 + 3, number * 7 + 6), i * 3);
      radius_m[i] = values[number * 7 + 6];
      touched[i] = this.facts.touched === number ? 1 : 0;
    });
    const sides = Math.min(Math.max(Math.floor((trunk_triangles / Math.max(count, 1) + 2) / 3), 3), 16);
    return this.add({
      ...shapes.unit_trunk(sides),
      from: { size: 3, data: from, instanced: 1 },
      to: { size: 3, data: to, instanced: 1 },
      radius_m: { data: radius_m, instanced: 1 },
      touched: { data: touched, instanced: 1 },
    }, program);
  }

  private add_trunks(): void {
    const obstacles = floats_of(this.arrays, "obstacles");
    const box_numbers = Array.from(array_of(this.arrays, "box_numbers"));
    const round = [...Array(obstacles.length / 7).keys()].filter((i) => !box_numbers.includes(i));
    this.parts.trunks = this.add_round(obstacles, round, this.program(shaders.trunk, {}, "trunk"));
    const corners = floats_of(this.arrays, "box_corners");
    const add_boxes = (is_touched: boolean, color: string) => this.add(shapes.boxes(corners, [...box_numbers.keys()].filter((i) => (this.facts.touched === box_numbers[i]) === is_touched)), this.program(shaders.surface, { shading: { value: 1 } }, color));
    this.parts.walls = add_boxes(false, "trunk");
    this.parts.touched_wall = add_boxes(true, "alert");
  }

  /// After all else: one sees through them.
  private add_crowns(): void {
    const crowns = floats_of(this.arrays, "crowns");
    const green = this.program(shaders.trunk, { opacity: { value: 0.25 } }, "crown", { transparent: true, depthWrite: false });
    this.parts.crowns = this.add_round(crowns, [...Array(crowns.length / 7).keys()], green);
  }

  /// Segments of the plans lie one after the other, so that a plan is a range of them.
  private count_plan_segments(): Uint32Array {
    const starts = array_of(this.arrays, "plan_start");
    const total = array_of(this.arrays, "plan_points").length / 3;
    const segments = new Uint32Array(starts.length + 1);
    for (let i = 0; i < starts.length; ++i) {
      const end = i + 1 < starts.length ? starts[i + 1] : total;
      segments[i + 1] = segments[i] + Math.max(end - starts[i] - 1, 0);
    }
    return segments;
  }

  private add_plans_and_points(): void {
    const starts = array_of(this.arrays, "plan_start");
    const points = floats_of(this.arrays, "plan_points");
    const pairs: number[] = [];
    for (let i = 0; i < starts.length; ++i) {
      const count = this.plan_segments[i + 1] - this.plan_segments[i];
      for (let k = 0; k < count; ++k) pairs.push(starts[i] + k, starts[i] + k + 1);
    }
    this.parts.plan = this.add_lines(shapes.thick_lines(points, pairs), "plan", 3);

    const map = floats_of(this.arrays, "map_points");
    const end_s = this.times[this.times.length - 1]; // what is remembered until then is remembered in the last picture, too
    this.parts.map = this.add({
      position: { size: 3, data: map },
      from_s: { data: floats_of(this.arrays, "map_from") },
      to_s: { data: floats_of(this.arrays, "map_to").map((to_s) => (to_s >= end_s ? 1e9 : to_s)) },
    }, this.program(shaders.points, { size_m: { value: 0.07 } }, "map"), this.gl.POINTS);

    const hits_s = floats_of(this.arrays, "hits_t");
    this.parts.hits = this.add({
      position: { size: 3, data: floats_of(this.arrays, "hits") },
      from_s: { data: hits_s },
      to_s: { data: hits_s.map((seen_s) => seen_s + hits_shown_s) },
    }, this.program(shaders.points, { size_m: { value: 0.1 } }, "hit"), this.gl.POINTS);
  }

  private add_flight(): void {
    const { times, truth, facts } = this;
    const stride = Math.max(1, Math.ceil(times.length / path_segments));
    const positions = new Float32Array(times.length * 3);
    for (let i = 0; i < times.length; ++i) positions.set(truth.subarray(i * 7, i * 7 + 3), i * 3);
    this.parts.path = this.add_lines(shapes.thick_lines(positions, shapes.chain(times.length, stride), times), "truth", 1.5);

    const vertices = floats_of(this.arrays, "wing_vertices");
    const triangles = Uint32Array.from(array_of(this.arrays, "wing_triangles"));
    const wing = { position: { size: 3, data: vertices }, index: { data: triangles } };
    const lit = { shading: { value: 1 } };
    const flattened = new Transform();
    flattened.scale.z = 1e-4;
    flattened.setParent(this.scene);
    this.parts.shadow = this.add(wing, this.program(shaders.surface, { shading: { value: 0 }, opacity: { value: 0.35 } }, "shadow",
      { transparent: true, depthWrite: false }), this.gl.TRIANGLES, flattened);
    this.parts.drop = this.add_lines(shapes.thick_lines([0, 0, 0, 0, 0, 1], [0, 1]), "truth", 1, 0.5);
    this.parts.aircraft = this.add(wing, this.program(shaders.surface, lit, "truth"));
    if (facts.camera) this.parts.frusta = this.add_lines(shapes.camera_frusta(facts.camera), "frusta", 1.2, 0.8);
    if (facts.impact) {
      this.parts.impact = this.add_lines(shapes.impact_mark(0.25), "alert", 2);
      this.parts.impact?.position.set(...facts.impact.position);
    }
    const touched_box = floats_of(this.arrays, "touched_box");
    if (touched_box.length === 6) {
      const corners = shapes.box(touched_box.subarray(0, 3), touched_box.subarray(3));
      this.parts.touched = this.add(corners, this.program(shaders.surface, lit, "alert"));
    }
    const tips = floats_of(this.arrays, "wing_tips");
    if (tips.length === 6 && truth.length === times.length * 7) {
      this.parts.trail = this.add(shapes.swept_wing(times, truth, tips),
        this.program(shaders.trail, { length_s: { value: trail_length_s }, opacity: { value: 0.35 } }, "truth",
          { transparent: true, depthWrite: false }), this.gl.TRIANGLE_STRIP);
    }
    this.parts.estimate = this.add(wing, this.program(shaders.surface, { ...lit, opacity: { value: 0.5 } }, "estimate",
      { transparent: true, depthWrite: false }));
  }

  /// Reads the colours from the page's style, so that they are said once.
  set_theme(): void {
    const style = getComputedStyle(document.documentElement);
    const color = (name: string) => {
      const value = parseInt(style.getPropertyValue(`--${name}`).trim().slice(1), 16);
      return [(value >> 16) / 255, ((value >> 8) & 255) / 255, (value & 255) / 255];
    };
    for (const { uniform, name } of this.colored) uniform.value = color(name);
    this.shared.alert_color.value = color("alert");
    const background = color("sky");
    this.shared.background.value = background;
    this.gl.clearColor(background[0], background[1], background[2], 1);
    this.plan_colors.splice(0, Infinity, color("plan"), color("alert"));
  }

  /// Gives everything on the graphics card back: a browser allows few contexts, and forgets them late.
  close(): void {
    this.gl.getExtension("WEBGL_lose_context")?.loseContext();
  }

  resize(width_px: number, height_px: number): void {
    if (width_px < 1 || height_px < 1 || (width_px === this.renderer.width && height_px === this.renderer.height)) return;
    this.renderer.setSize(width_px, height_px);
    this.canvas.style.width = this.canvas.style.height = ""; // as above
  }

  private aspect(): number {
    return this.renderer.width / this.renderer.height;
  }

  set_view(view: ViewName): void {
    enter_view(this.orbit, view, this.pose, this.heading_rad(), this.bounds, this.aspect());
  }

  fit(): void {
    fit(this.orbit, this.bounds, this.aspect());
  }

  /// The direction of flight over the last half second: steadier than the nose. The nose where it hardly moved.
  private heading_rad(): number {
    const [x, y, z, w] = this.pose.quaternion;
    const nose_rad = Math.atan2(2 * (x * y + w * z), 1 - 2 * (y * y + z * z));
    if (!pose_at(this.times, this.truth, this.time_s - 0.5, this.earlier)) return nose_rad;
    const dx = this.pose.position[0] - this.earlier.position[0];
    const dy = this.pose.position[1] - this.earlier.position[1];
    return Math.hypot(dx, dy) > 0.5 ? Math.atan2(dy, dx) : nose_rad;
  }

  draw(time_s: number): void {
    this.time_s = time_s;
    this.shared.now_s.value = time_s;
    const flown = pose_at(this.times, this.truth, time_s, this.pose);
    const estimated = pose_at(this.times, this.estimate, time_s, this.estimate_pose);
    this.place_aircraft(flown, estimated);
    this.choose_ranges(time_s);
    this.place_camera();
    this.renderer.render({ scene: this.scene, camera: this.camera, sort: false, frustumCull: false });
  }

  private place_aircraft(flown: boolean, estimated: boolean): void {
    const outside = this.orbit.view !== "onboard";
    const place = (mesh: Mesh | undefined, visible: boolean, pose: Pose) => {
      if (!mesh) return;
      mesh.visible = visible;
      mesh.position.copy(pose.position);
      mesh.quaternion.copy(pose.quaternion);
    };
    place(this.parts.aircraft, flown && outside, this.pose);
    place(this.parts.shadow, flown && outside, this.pose);
    place(this.parts.frusta, flown && outside && this.layers.frusta, this.pose);
    const ended = this.time_s >= this.times[this.times.length - 1] - 1e-3;
    place(this.parts.touched, flown && outside && ended, this.pose);
    place(this.parts.estimate, estimated && outside && this.layers.estimate, this.estimate_pose);
    // The map and the plan lie in the world of the estimate, which drifts. They are drawn as the aircraft believes
    // they lie relative to itself: so what it remembers of a trunk lies at that trunk, unless it was detected wrongly.
    if (estimated) motion_between(this.estimate_pose, this.pose, this.remembered);
    place(this.parts.map, this.layers.map, this.remembered);
    place(this.parts.plan, this.layers.plan, this.remembered);
    const { drop, trail, path } = this.parts;
    if (drop) {
      drop.visible = flown && outside;
      drop.position.set(this.pose.position[0], this.pose.position[1], 0);
      drop.scale.z = Math.max(this.pose.position[2], 0.001);
    }
    if (trail) trail.visible = outside;
    if (path) path.visible = outside;
  }

  /// What is drawn of the flight's arrays at a moment.
  private choose_ranges(time_s: number): void {
    const show = (mesh: Mesh | undefined, start: number, count: number) => {
      if (!mesh) return;
      mesh.visible &&= count > 0;
      mesh.geometry.setDrawRange(start, Math.max(count, 0));
    };
    const { map, hits, plan, trail } = this.parts;
    show(map, 0, count_until(array_of(this.arrays, "map_from"), time_s));
    const hits_s = array_of(this.arrays, "hits_t");
    const first_hit = count_until(hits_s, time_s - hits_shown_s);
    if (hits) hits.visible = this.layers.hits;
    show(hits, first_hit, count_until(hits_s, time_s) - first_hit);
    const first_moment = Math.max(count_until(this.times, time_s - trail_length_s) - 1, 0);
    const last_moment = Math.min(count_until(this.times, time_s) + 1, this.times.length);
    show(trail, first_moment * 2, (last_moment - first_moment) * 2);

    const index = count_until(array_of(this.arrays, "plan_t"), time_s) - 1;
    if (!plan) return;
    plan.visible &&= index >= 0;
    if (index < 0) return;
    const first = this.plan_segments[index];
    show(plan, first * 6, (this.plan_segments[index + 1] - first) * 6);
    const fallback = array_of(this.arrays, "plan_origin")[index] === fallback_origin;
    plan.program.uniforms.color.value = this.plan_colors[fallback ? 1 : 0];
  }

  private place_camera(): void {
    this.eye = eye_of(this.orbit, this.pose, this.heading_rad(), this.facts.camera);
    const { position, target, up, field_of_view_deg } = this.eye;
    this.camera.up.copy(up);
    this.camera.position.copy(position);
    this.camera.lookAt(target);
    const onboard = this.orbit.view === "onboard";
    const reach_m = onboard ? 0 : this.orbit.distance_m;
    const [near, far] = [Math.max(0.05, reach_m * 0.01), Math.max(1000, reach_m * 4)];
    this.camera.perspective({ fov: field_of_view_deg, aspect: this.aspect(), near, far });
    this.shared.fade_m.value = [Math.max(25, reach_m * 1.5), Math.max(110, reach_m * 4)];
    this.shared.see_through_m.value = this.orbit.view === "follow" ? reach_m * 0.9 : 0;
    this.shared.viewport_px.value = [this.renderer.width, this.renderer.height];
    const slope = Math.tan((field_of_view_deg / 2) * (Math.PI / 180));
    this.shared.pixels_per_radian.value = (this.renderer.height * this.renderer.dpr) / (2 * slope);
  }

  /// Where a point of the world is on the canvas, in CSS pixels; null behind the eye.
  project(x: number, y: number, z: number): [number, number] | null {
    const point = new Vec3(x, y, z).applyMatrix4(this.camera.viewMatrix);
    if (point.z > -this.camera.near) return null;
    point.applyMatrix4(this.camera.projectionMatrix);
    return [((point.x + 1) / 2) * this.canvas.clientWidth, ((1 - point.y) / 2) * this.canvas.clientHeight];
  }

  /// The colour drawn at a place in CSS pixels. Draws first: the browser keeps no picture for us.
  pixel(x_px: number, y_px: number): number[] {
    this.draw(this.time_s);
    const color = new Uint8Array(4);
    const scale = this.gl.drawingBufferWidth / this.canvas.clientWidth;
    const row = this.gl.drawingBufferHeight - 1 - Math.floor(y_px * scale);
    this.gl.readPixels(Math.floor(x_px * scale), row, 1, 1, this.gl.RGBA, this.gl.UNSIGNED_BYTE, color);
    return [...color];
  }

  /// Triangles of the last picture.
  triangles(): number {
    let total = 0;
    for (const mesh of Object.values(this.parts)) {
      if (!mesh?.visible) continue;
      const { drawRange, instancedCount, isInstanced } = mesh.geometry;
      const times = isInstanced ? instancedCount : 1;
      if (mesh.mode === this.gl.TRIANGLES) total += (drawRange.count / 3) * times;
      if (mesh.mode === this.gl.TRIANGLE_STRIP) total += Math.max(drawRange.count - 2, 0) * times;
    }
    return total;
  }

  /// Seconds per picture, over `count` pictures drawn one after the other.
  draw_seconds(count: number): number {
    const begin_ms = performance.now();
    for (let i = 0; i < count; ++i) this.pixel(1, 1); // reading back waits for the picture
    return (performance.now() - begin_ms) / 1000 / count;
  }
}
