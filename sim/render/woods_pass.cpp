#include "sim/render/woods_pass.hpp"

#include <algorithm>
#include <cstddef>
#include <memory>
#include <optional>
#include <stdexcept>
#include <string>
#include <utility>
#include <vector>

#include "sim/render/woods_gl.hpp"
#include "sim/render/woods_shaders.hpp"

namespace understory {
namespace {

/// Clip coordinates of OpenGL from the world, column by column.
Eigen::Matrix4f clip_from_world(const Eye& eye) {
  const double left = -(eye.center_x_px + 0.5), right = eye.width_px - 0.5 - eye.center_x_px;
  const double top = eye.center_y_px + 0.5, bottom = -(eye.height_px - 0.5 - eye.center_y_px);
  Eigen::Matrix4d projection = Eigen::Matrix4d::Zero();
  projection(0, 0) = 2 * eye.focal_px / (right - left);
  projection(0, 2) = (right + left) / (right - left);
  projection(1, 1) = 2 * eye.focal_px / (top - bottom);
  projection(1, 2) = (top + bottom) / (top - bottom);
  projection(2, 2) = -(far_m + near_m) / (far_m - near_m);
  projection(2, 3) = -2 * far_m * near_m / (far_m - near_m);
  projection(3, 2) = -1;
  Eigen::Isometry3d T_camera_world = eye.T_world_camera.inverse();
  Eigen::Matrix4d flipped = T_camera_world.matrix();  // OpenCV's y looks down and its z ahead
  flipped.row(1) *= -1;
  flipped.row(2) *= -1;
  return (projection * flipped).cast<float>();
}

constexpr double further_m = 40;  ///< how much further than the view pieces are held

/// Half as large: colour averaged with its alpha as weight, so that leaves keep theirs; alpha a little
/// raised, so that leaves far away do not vanish.
WoodsPicture half_of(const WoodsPicture& picture) {
  WoodsPicture half{std::max(1, picture.width_px / 2), std::max(1, picture.height_px / 2), {}};
  half.rgba.resize(static_cast<std::size_t>(4 * half.width_px * half.height_px));
  const int step_x = picture.width_px / half.width_px, step_y = picture.height_px / half.height_px;
  for (int y = 0; y < half.height_px; ++y)
    for (int x = 0; x < half.width_px; ++x) {
      int sum[3] = {0, 0, 0}, alpha = 0, plain[3] = {0, 0, 0};
      for (int v = 0; v < step_y; ++v)
        for (int u = 0; u < step_x; ++u) {
          const std::uint8_t* from =
              picture.rgba.data() + 4 * ((y * step_y + v) * picture.width_px + x * step_x + u);
          for (int i = 0; i < 3; ++i) sum[i] += from[i] * from[3], plain[i] += from[i];
          alpha += from[3];
        }
      const int count = step_x * step_y;
      std::uint8_t* to = half.rgba.data() + 4 * (y * half.width_px + x);
      for (int i = 0; i < 3; ++i)
        to[i] = static_cast<std::uint8_t>(alpha > 0 ? sum[i] / alpha : plain[i] / count);
      to[3] = static_cast<std::uint8_t>(std::min(255, alpha * 21 / (20 * count)));
    }
  return half;
}

}  // namespace

struct WoodsPass::Implementation {
  Gl gl;
  std::shared_ptr<const WoodsMesh> mesh;
  /// Of each piece, in the buffers: nothing where it is not held.
  std::vector<std::optional<std::size_t>> first_index;
  Eigen::Vector3d held_from_world = Eigen::Vector3d::Zero();
  double held_m = 0;                   ///< all pieces this near to the place are held
  std::array<unsigned, 5> programs{};  ///< solid and leaves in gray, in colour; numbers
  std::array<unsigned, 2> buffers{};   ///< vertices, indices
  std::array<unsigned, woods_texture_count> textures{};

  Implementation(std::shared_ptr<const WoodsMesh> drawn, const OffscreenContext& context)
      : gl(context), mesh(std::move(drawn)) {
    programs = {
        program_of(gray_vertex_source, gray_solid_source), program_of(gray_vertex_source, gray_leaves_source),
        program_of(colour_vertex_source, solid_source), program_of(colour_vertex_source, leaves_source),
        program_of(colour_vertex_source, numbers_source)};
    gl.GenBuffers(2, buffers.data());
    gl.GenTextures(static_cast<int>(textures.size()), textures.data());
    for (std::size_t i = 0; i < woods_texture_count; ++i) upload(textures[i], mesh->textures[i]);
    gl.BindTexture(gl_texture_2d, 0);
  }

  unsigned program_of(const char* main_of_vertices, const char* fragment_source) const {
    const unsigned program = gl.CreateProgram();
    const std::string vertex_source = std::string(placed_source) + main_of_vertices;
    for (const auto& [kind, source] : {std::pair(gl_vertex_shader, vertex_source.c_str()),
                                       std::pair(gl_fragment_shader, fragment_source)}) {
      const unsigned shader = gl.CreateShader(kind);
      gl.ShaderSource(shader, 1, &source, nullptr);
      gl.CompileShader(shader);
      int compiled = 0;
      gl.GetShaderiv(shader, gl_compile_status, &compiled);
      if (compiled == 0) throw std::runtime_error("this OpenGL cannot compile the woods' shaders");
      gl.AttachShader(program, shader);
      gl.DeleteShader(shader);
    }
    const std::array<const char*, 5> attributes{"position", "texture", "tint", "object", "ribbon"};
    for (unsigned i = 0; i < attributes.size(); ++i) gl.BindAttribLocation(program, i, attributes[i]);
    gl.LinkProgram(program);
    int linked = 0;
    gl.GetProgramiv(program, gl_link_status, &linked);
    if (linked == 0) throw std::runtime_error("this OpenGL cannot link the woods' shaders");
    return program;
  }

  /// Of the texture that is bound. Ground and leaves, which fill most of a picture, take the nearest texel
  /// where they are made smaller: a tenth of a pair's cost.
  void set_filter(WoodsTexture texture, bool smooth) const {
    const bool smooth_if_smaller = smooth && texture < WoodsTexture::ground;
    gl.TexParameteri(gl_texture_2d, gl_min_filter, smooth_if_smaller ? gl_linear_mipmap : gl_nearest_mipmap);
    gl.TexParameteri(gl_texture_2d, gl_mag_filter, smooth ? gl_linear : gl_nearest);
  }

  void upload(unsigned texture, WoodsPicture picture) const {
    if (picture.rgba.empty()) return;
    gl.BindTexture(gl_texture_2d, texture);
    gl.PixelStorei(gl_unpack, 1);
    for (int level = 0;; ++level) {
      gl.TexImage2D(gl_texture_2d, level, gl_rgba_format, picture.width_px, picture.height_px, 0,
                    gl_rgba_format, gl_unsigned_byte_type, picture.rgba.data());
      if (picture.width_px == 1 && picture.height_px == 1) return;
      picture = half_of(picture);
    }
  }

  /// Brings all pieces within reach of the eye into the buffers, if they are not there yet, and some more, so
  /// that this happens seldom.
  void hold(const Eigen::Vector3d& eye, double reach_m) {
    if ((eye - held_from_world).norm() + reach_m <= held_m) return;
    held_from_world = eye;
    held_m = reach_m + further_m;
    first_index.assign(mesh->pieces.size(), std::nullopt);
    std::vector<std::uint32_t> wanted;
    std::size_t vertex_count = 0, index_count = 0;
    for (std::size_t i = 0; i < mesh->pieces.size(); ++i) {
      const WoodsPiece& piece = mesh->pieces[i];
      if (piece.box_world.exteriorDistance(eye) > held_m) continue;
      wanted.push_back(static_cast<std::uint32_t>(i));
      vertex_count += piece.vertex_count;
      index_count += piece.index_count;
    }
    const auto bytes = [](std::size_t count, std::size_t size) {
      return static_cast<std::ptrdiff_t>(count * size);
    };
    gl.BindBuffer(gl_array_buffer, buffers[0]);
    gl.BufferData(gl_array_buffer, bytes(vertex_count, sizeof(WoodsVertex)), nullptr, gl_static_draw);
    gl.BindBuffer(gl_element_array_buffer, buffers[1]);
    gl.BufferData(gl_element_array_buffer, bytes(index_count, sizeof(std::uint32_t)), nullptr,
                  gl_static_draw);
    std::size_t vertices = 0, indices = 0;
    visit_triangles(*mesh, wanted, [&](std::uint32_t piece, const WoodsTriangles& triangles) {
      std::vector<std::uint32_t> shifted = triangles.indices;
      for (std::uint32_t& index : shifted) index += static_cast<std::uint32_t>(vertices);
      gl.BufferSubData(gl_array_buffer, bytes(vertices, sizeof(WoodsVertex)),
                       bytes(triangles.vertices.size(), sizeof(WoodsVertex)), triangles.vertices.data());
      gl.BufferSubData(gl_element_array_buffer, bytes(indices, sizeof(std::uint32_t)),
                       bytes(shifted.size(), sizeof(std::uint32_t)), shifted.data());
      first_index[piece] = indices;
      vertices += triangles.vertices.size();
      indices += shifted.size();
    });
    gl.BindBuffer(gl_array_buffer, 0);
    gl.BindBuffer(gl_element_array_buffer, 0);
  }

  /// Ranges to draw with one texture.
  struct Batch {
    std::vector<int> counts;
    std::vector<const void*> offsets;
    void add(std::size_t first_of_piece, const WoodsRange& range) {
      if (range.count == 0) return;
      counts.push_back(static_cast<int>(range.count));
      offsets.push_back(
          reinterpret_cast<const void*>(sizeof(std::uint32_t) * (first_of_piece + range.first)));
    }
  };

  /// What is drawn after one another: first what hides most of the rest.
  enum Layer : std::size_t {
    closed_solids,
    near_solids,
    near_leaves,
    far_solids,
    ground,
    far_leaves,
    layers
  };
  /// Of a layer, by whether textures are smoothed, and by texture.
  using Batches = std::array<std::array<std::array<Batch, woods_texture_count>, 2>, layers>;

  Batches batches_for(const std::array<Eye, 2>& eyes, WoodsDrawing drawing, const WoodsDetail& detail) const {
    std::vector<std::pair<double, const WoodsPart*>> seen;
    for (const WoodsPart& part : mesh->parts) {
      const Eigen::Vector3d eye = eyes[0].T_world_camera.translation();
      const double range_m = part.whole_world.exteriorDistance(eye);
      GeomBox box;
      box.T_world_box.translation() = part.box_world.center();
      box.half_size = 0.5 * part.box_world.sizes();
      if (range_m < detail.reach_m && (may_see(eyes[0], box) || may_see(eyes[1], box)))
        seen.emplace_back(range_m, &part);
    }
    std::ranges::stable_sort(seen, {}, [](const auto& one) { return one.first; });
    const bool is_gray = drawing == WoodsDrawing::gray;
    Batches batches;
    for (const auto& [range_m, part] : seen) {
      const std::size_t first = first_index[part->piece].value();
      const std::size_t far = range_m > detail.near_m;
      const bool smooth = !is_gray || range_m <= detail.smooth_m;
      const bool tubes = is_gray && far == 0 && part->coarse.count > 0;
      const Layer solids = part->texture == WoodsTexture::ground ? ground
                           : far != 0                            ? far_solids
                           : tubes                               ? closed_solids
                                                                 : near_solids;
      const auto texture = static_cast<std::size_t>(part->texture);
      batches[solids][smooth][texture].add(
          first, tubes && range_m > detail.fine_m ? part->coarse : part->solid[far]);
      constexpr auto leaves = static_cast<std::size_t>(WoodsTexture::leaves);
      batches[far != 0 ? far_leaves : near_leaves][smooth][leaves].add(first, part->leaves[far]);
    }
    return batches;
  }

  void set_state(const Eye& eye, int left_px) const {
    gl.Viewport(left_px, 0, eye.width_px, eye.height_px);
    for (const unsigned off : {gl_cull_face, gl_blend, gl_scissor_test}) gl.Disable(off);
    // MuJoCo's mirrors are drawn with clip planes.
    for (unsigned plane = 0; plane < 6; ++plane) gl.Disable(gl_clip_plane0 + plane);
    gl.Enable(gl_depth_test);
    gl.DepthFunc(gl_lequal);
    gl.DepthMask(1);
    gl.DepthRange(0, 1);
    gl.ColorMask(1, 1, 1, 1);
    gl.ActiveTexture(gl_texture0);
    gl.BindBuffer(gl_array_buffer, buffers[0]);
    gl.BindBuffer(gl_element_array_buffer, buffers[1]);
    const auto attribute = [&](unsigned index, int size, unsigned type, bool scaled, std::size_t offset) {
      gl.EnableVertexAttribArray(index);
      gl.VertexAttribPointer(index, size, type, scaled, sizeof(WoodsVertex),
                             reinterpret_cast<const void*>(offset));
    };
    attribute(0, 3, gl_float, false, offsetof(WoodsVertex, position_world));
    attribute(1, 2, gl_float, false, offsetof(WoodsVertex, texture));
    attribute(2, 4, gl_unsigned_byte_type, true, offsetof(WoodsVertex, tint));
    attribute(3, 4, gl_unsigned_byte_type, true, offsetof(WoodsVertex, object));
    attribute(4, 3, gl_float, false, offsetof(WoodsVertex, ribbon));
  }

  /// Ribbons turn to one eye, for both alike.
  void use(unsigned program, const Eye& eye, const Eigen::Vector3d& turned_to) const {
    const Eigen::Vector3f turn = turned_to.cast<float>();
    gl.UseProgram(program);
    const Eigen::Matrix4f clip = clip_from_world(eye);
    gl.UniformMatrix4fv(gl.GetUniformLocation(program, "clip_from_world"), 1, 0, clip.data());
    const Eigen::Vector3f place = eye.T_world_camera.translation().cast<float>();
    gl.Uniform3f(gl.GetUniformLocation(program, "eye"), place.x(), place.y(), place.z());
    gl.Uniform3f(gl.GetUniformLocation(program, "turned_to"), turn.x(), turn.y(), turn.z());
    gl.Uniform3f(gl.GetUniformLocation(program, "haze"), 0.78f, 0.83f, 0.86f);
    gl.Uniform1f(gl.GetUniformLocation(program, "haze_m"), static_cast<float>(mesh->haze_m));
    gl.Uniform1i(gl.GetUniformLocation(program, "picture"), 0);
  }
};

WoodsPass::WoodsPass(std::shared_ptr<const WoodsMesh> mesh, const OffscreenContext& context)
    : implementation_(std::make_unique<Implementation>(std::move(mesh), context)) {}

WoodsPass::~WoodsPass() {
  const Implementation& my = *implementation_;
  for (const unsigned program : my.programs) my.gl.DeleteProgram(program);
  my.gl.DeleteBuffers(2, my.buffers.data());
  my.gl.DeleteTextures(static_cast<int>(my.textures.size()), my.textures.data());
}

void WoodsPass::draw(const std::array<Eye, 2>& eyes, std::size_t count, WoodsDrawing drawing,
                     const WoodsDetail& detail, bool clears) {
  Implementation& my = *implementation_;
  my.hold(eyes[0].T_world_camera.translation(), detail.reach_m);
  my.gl.PushAttrib(gl_all_attrib_bits);
  my.gl.PushClientAttrib(gl_client_all);
  using My = Implementation;
  const My::Batches batches = my.batches_for(eyes, drawing, detail);
  const auto& [gray_solid, gray_leaves, colour_solid, colour_leaves, numbers] = my.programs;
  const auto program_for = [&](std::size_t layer) {
    const bool is_leaves = layer == My::near_leaves || layer == My::far_leaves;
    if (drawing == WoodsDrawing::numbers) return numbers;
    if (drawing == WoodsDrawing::gray) return is_leaves ? gray_leaves : gray_solid;
    return is_leaves ? colour_leaves : colour_solid;
  };
  const Eigen::Vector3d turned_to = eyes[0].T_world_camera.translation();
  for (std::size_t eye = 0; eye < count; ++eye) {
    my.set_state(eyes[eye], static_cast<int>(eye) * eyes[0].width_px);
    if (clears && eye == 0) {
      my.gl.ClearColor(0, 0, 0, 0);
      my.gl.Clear(gl_color_bit | gl_depth_bit);
    }
    unsigned used = 0;
    for (std::size_t layer = 0; layer < My::layers; ++layer) {
      if (layer == My::closed_solids) my.gl.Enable(gl_cull_face);
      if (layer == My::near_solids) my.gl.Disable(gl_cull_face);
      if (program_for(layer) != used) my.use(used = program_for(layer), eyes[eye], turned_to);
      for (const bool smooth : {true, false})
        for (std::size_t texture = 0; texture < woods_texture_count; ++texture) {
          const My::Batch& batch = batches[layer][smooth][texture];
          if (batch.counts.empty()) continue;
          my.gl.BindTexture(gl_texture_2d, my.textures[texture]);
          my.set_filter(static_cast<WoodsTexture>(texture), smooth);
          my.gl.MultiDrawElements(gl_triangles, batch.counts.data(), gl_unsigned_int, batch.offsets.data(),
                                  static_cast<int>(batch.counts.size()));
        }
    }
  }
  for (unsigned index = 0; index < 5; ++index) my.gl.DisableVertexAttribArray(index);
  my.gl.BindBuffer(gl_array_buffer, 0);
  my.gl.BindBuffer(gl_element_array_buffer, 0);
  my.gl.UseProgram(0);
  my.gl.PopClientAttrib();
  my.gl.PopAttrib();
}

}  // namespace understory
