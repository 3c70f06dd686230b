// The programs of the graphics card. Everything far away fades into the background's colour.

const fade = `
uniform vec3 background;
uniform vec2 fade_m;
vec3 faded(vec3 color, float depth_m) { return mix(color, background, 0.9 * smoothstep(fade_m.x, fade_m.y, depth_m)); }
`;

const matrices = `uniform mat4 modelMatrix, viewMatrix, projectionMatrix;`;

function vertex_shader(body: string): string {
  return `#version 300 es\nprecision highp float;\n${matrices}\n${body}`;
}

function fragment_shader(body: string): string {
  return `#version 300 es\nprecision highp float;\nout vec4 result;\nuniform vec3 color;\nuniform float opacity;\n${fade}\n${body}`;
}

/// Surfaces: the side that looks up is brighter. Facets need no normals: the shader finds them.
export const surface = {
  vertex: vertex_shader(`
in vec3 position;
out vec3 seen_position;
out vec3 world_position;
void main() {
  vec4 world = modelMatrix * vec4(position, 1.0);
  vec4 seen = viewMatrix * world;
  world_position = world.xyz;
  seen_position = seen.xyz;
  gl_Position = projectionMatrix * seen;
}`),
  fragment: fragment_shader(`
in vec3 seen_position;
in vec3 world_position;
uniform vec3 cameraPosition;
uniform float shading;
void main() {
  float light = 1.0;
  if (shading > 0.0) {
    vec3 normal = normalize(cross(dFdx(world_position), dFdy(world_position)));
    if (dot(normal, cameraPosition - world_position) < 0.0) normal = -normal;
    light = 0.72 + 0.28 * dot(normal, vec3(-0.36, 0.48, 0.8));
  }
  result = vec4(faded(color * light, -seen_position.z), opacity);
}`),
};

/// Trunks: one shape, drawn once per obstacle between its two ends.
export const trunk = {
  vertex: vertex_shader(`
in vec3 position;
in vec3 from;
in vec3 to;
in float radius_m;
in float touched;
out float light;
out float depth_m;
out float alert;
void main() {
  vec3 along = to - from;
  float length_m = length(along);
  along = length_m > 0.0 ? along / length_m : vec3(0.0, 0.0, 1.0);
  vec3 across = normalize(abs(along.z) < 0.9 ? cross(along, vec3(0.0, 0.0, 1.0)) : cross(along, vec3(1.0, 0.0, 0.0)));
  vec3 outward = position.x * across + position.y * cross(along, across);
  vec4 seen = viewMatrix * vec4(mix(from, to, position.z) + radius_m * outward, 1.0);
  light = 0.74 + 0.26 * dot(outward, vec3(-0.6, 0.64, 0.48));
  depth_m = -seen.z;
  alert = touched;
  gl_Position = projectionMatrix * seen;
}`),
  fragment: fragment_shader(`
in float light;
in float depth_m;
in float alert;
uniform vec3 alert_color;
uniform float see_through_m;
void main() {
  // What stands between the eye and the aircraft is drawn like a screen door.
  if (depth_m < see_through_m && mod(floor(gl_FragCoord.x) + floor(gl_FragCoord.y), 2.0) < 1.0) discard;
  vec3 own = alert > 0.5 ? alert_color * (0.4 + 0.6 * light) : faded(color * light, depth_m);
  result = vec4(own, opacity);
}`),
};

/// Lines with a width in pixels. Their part after the present moment is not drawn.
export const line = {
  vertex: vertex_shader(`
in vec3 position;
in vec3 other;
in float side;
in float time_s;
uniform vec2 viewport_px;
uniform float width_px;
out float moment_s;
out float depth_m;
void main() {
  mat4 project = projectionMatrix * viewMatrix * modelMatrix;
  vec4 here = project * vec4(position, 1.0);
  vec4 there = project * vec4(other, 1.0);
  const float near_m = 0.06;  // behind the eye there is no direction on the screen: cut there
  if (here.w < near_m && there.w > near_m) here = mix(here, there, (near_m - here.w) / (there.w - here.w));
  if (there.w < near_m && here.w > near_m) there = mix(there, here, (near_m - there.w) / (here.w - there.w));
  vec2 along = (there.xy / there.w - here.xy / here.w) * viewport_px;
  vec2 across = dot(along, along) > 1e-9 ? normalize(vec2(-along.y, along.x)) : vec2(0.0, 1.0);
  here.xy += side * across * width_px / viewport_px * here.w;
  moment_s = time_s;
  depth_m = here.w;
  gl_Position = here;
}`),
  fragment: fragment_shader(`
in float moment_s;
in float depth_m;
uniform float now_s;
void main() {
  if (moment_s > now_s) discard;
  result = vec4(faded(color, depth_m), opacity);
}`),
};

/// The swept wing: fades with its age.
export const trail = {
  vertex: vertex_shader(`
in vec3 position;
in float time_s;
out float moment_s;
void main() {
  moment_s = time_s;
  gl_Position = projectionMatrix * viewMatrix * vec4(position, 1.0);
}`),
  fragment: `#version 300 es
precision highp float;
in float moment_s;
uniform vec3 color;
uniform float now_s, length_s, opacity;
out vec4 result;
void main() {
  float age = (now_s - moment_s) / length_s;
  if (age < 0.0 || age > 1.0) discard;
  result = vec4(color, opacity * (1.0 - age));
}`,
};

/// Points in the world that are there from one moment to another.
export const points = {
  vertex: vertex_shader(`
in vec3 position;
in float from_s;
in float to_s;
uniform float now_s, size_m, pixels_per_radian;
out float depth_m;
void main() {
  vec4 seen = viewMatrix * modelMatrix * vec4(position, 1.0);
  depth_m = -seen.z;
  gl_Position = projectionMatrix * seen;
  gl_PointSize = clamp(size_m * pixels_per_radian / max(depth_m, 0.1), 2.0, 7.0);
  if (from_s > now_s || to_s <= now_s) gl_Position = vec4(2.0, 2.0, 2.0, 1.0);
}`),
  fragment: fragment_shader(`
in float depth_m;
void main() { result = vec4(faded(color, depth_m), opacity); }`),
};
