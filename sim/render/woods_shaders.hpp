#pragma once

namespace understory {

// Light and haze are worked out at the corners: a fragment costs one texel. What is solid has a program
// without `discard`, so that hidden fragments are thrown away before they are shaded.
inline constexpr const char* placed_source = R"(#version 110
attribute vec3 position;
attribute vec2 texture;
attribute vec4 tint;
attribute vec4 object;
attribute vec3 ribbon;
uniform mat4 clip_from_world;
uniform vec3 eye;
uniform vec3 turned_to;
uniform vec3 haze;
uniform float haze_m;
vec3 placed() {
  // A ribbon's corner lies beside its axis, as far as the ribbon is long, and as far before it.
  vec3 sight = normalize(turned_to - position);
  vec3 aside = cross(ribbon, sight);
  float radius = length(ribbon);
  return position + aside * (radius / max(length(aside), 0.000001)) + sight * radius;
}
)";
inline constexpr const char* colour_vertex_source = R"(
varying vec2 at;
varying vec3 colour;
varying float haziness;
varying vec4 number;
void main() {
  vec3 place = placed();
  gl_Position = clip_from_world * vec4(place, 1.0);
  at = texture;
  float clear = exp(-distance(place, eye) / haze_m);
  colour = tint.rgb * (2.0 * clear);
  haziness = 1.0 - clear;
  number = object;
})";
// Cameras see the green channel alone, and everything that a fragment needs is one varying.
inline constexpr const char* gray_vertex_source = R"(
varying vec4 seen;
void main() {
  vec3 place = placed();
  gl_Position = clip_from_world * vec4(place, 1.0);
  float clear = exp(-distance(place, eye) / haze_m);
  seen = vec4(texture, tint.g * (2.0 * clear), haze.g * (1.0 - clear));
})";
inline constexpr const char* gray_solid_source = R"(#version 110
uniform sampler2D picture;
varying vec4 seen;
void main() { gl_FragColor = vec4(vec3(texture2D(picture, seen.xy).g * seen.z + seen.w), 1.0); })";
inline constexpr const char* gray_leaves_source = R"(#version 110
uniform sampler2D picture;
varying vec4 seen;
void main() {
  vec4 texel = texture2D(picture, seen.xy);
  if (texel.a < 0.4) discard;
  gl_FragColor = vec4(vec3(texel.g * seen.z + seen.w), 1.0);
})";
inline constexpr const char* solid_source = R"(#version 110
uniform sampler2D picture;
uniform vec3 haze;
varying vec2 at;
varying vec3 colour;
varying float haziness;
void main() { gl_FragColor = vec4(texture2D(picture, at).rgb * colour + haze * haziness, 1.0); })";
inline constexpr const char* leaves_source = R"(#version 110
uniform sampler2D picture;
uniform vec3 haze;
varying vec2 at;
varying vec3 colour;
varying float haziness;
void main() {
  vec4 texel = texture2D(picture, at);
  if (texel.a < 0.4) discard;
  gl_FragColor = vec4(texel.rgb * colour + haze * haziness, 1.0);
})";
inline constexpr const char* numbers_source = R"(#version 110
uniform sampler2D picture;
varying vec2 at;
varying vec4 number;
void main() {
  if (texture2D(picture, at).a < 0.4) discard;
  gl_FragColor = vec4(number.rg, 0.0, 1.0);
})";

}  // namespace understory
