#include "sim/scene/woods_textures.hpp"

#include <Eigen/Core>
#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>
#include <random>

#include "sim/scene/meshes.hpp"
#include "sim/scene/textures.hpp"

namespace understory {
namespace {

using Eigen::Vector2d;

constexpr int cell_px = 128;

WoodsPicture picture_of(const GrayTexture& gray) {
  WoodsPicture picture{gray.width_px, gray.height_px, {}};
  for (const std::uint8_t level : gray.gray)
    for (int i = 0; i < 4; ++i) picture.rgba.push_back(i < 3 ? level : 255);
  return picture;
}

/// An ellipse with pointed ends, or a stroke where `width` is small, within one cell of the picture.
struct Leaf {
  Vector2d middle = Vector2d::Zero();  ///< px in the cell
  double turn_rad = 0;
  double half_px = 8;
  double width = 0.5;  ///< share of the length
  double gray = 128;
};

class LeafPainter {
 public:
  explicit LeafPainter(std::uint32_t seed) : generator_(seed) {
    for (std::size_t i = 0; i < picture_.rgba.size(); ++i) picture_.rgba[i] = i % 4 == 3 ? 0 : 100;
  }

  WoodsPicture paint() {
    begin(LeafPicture::leaves), paint_spray();
    begin(LeafPicture::more_leaves), paint_spray();
    begin(LeafPicture::needles), paint_needles();
    begin(LeafPicture::twigs), paint_twig({64, 2}, 0.5 * std::numbers::pi, 34, 5);
    begin(LeafPicture::frond), paint_frond({64, 2}, 0, 120, 26);
    begin(LeafPicture::fern), paint_fern();
    begin(LeafPicture::grass), paint_grass();
    begin(LeafPicture::thicket), paint_thicket();
    return std::move(picture_);
  }

 private:
  double uniform(double low, double high) {
    return low + (high - low) * std::uniform_real_distribution<double>(0, 1)(generator_);
  }
  void begin(LeafPicture cell) {
    left_ = cell_px * (static_cast<int>(cell) % 4);
    low_ = cell_px * (static_cast<int>(cell) / 4);
  }

  void paint(const Leaf& leaf) {
    const Vector2d along(std::cos(leaf.turn_rad), std::sin(leaf.turn_rad));
    const auto from = [&](double centre) { return std::max(0, static_cast<int>(centre - leaf.half_px)); };
    const auto to = [&](double centre) { return std::min<double>(cell_px, centre + leaf.half_px + 1); };
    for (int y = from(leaf.middle.y()); y < to(leaf.middle.y()); ++y)
      for (int x = from(leaf.middle.x()); x < to(leaf.middle.x()); ++x) {
        const Vector2d offset = Vector2d(x + 0.5, y + 0.5) - leaf.middle;
        const double a = offset.dot(along) / leaf.half_px;
        const double b = (along.x() * offset.y() - along.y() * offset.x()) / leaf.half_px;
        // A stroke is never thinner than a pixel.
        const double width = std::max(leaf.width * (1 - a * a), 0.7 / leaf.half_px);
        if (std::abs(a) >= 1 || std::abs(b) > width) continue;
        const double level = leaf.gray * (leaf.width > 0.3 && std::abs(b) < 0.06 ? 1.15 : 1);
        std::uint8_t* rgba = picture_.rgba.data() + 4 * ((low_ + y) * picture_.width_px + left_ + x);
        for (int i = 0; i < 3; ++i) rgba[i] = static_cast<std::uint8_t>(std::min(level, 255.0));
        rgba[3] = 255;
      }
  }

  void paint_spray() {
    for (int leaf = 0; leaf < 120; ++leaf) {
      const double out = 55 * std::sqrt(uniform(0, 1)), angle = uniform(0, 2 * std::numbers::pi);
      const Vector2d middle(64 + out * std::cos(angle), 64 + out * std::sin(angle));
      const double turn = uniform(0, 2 * std::numbers::pi), half_px = uniform(6, 10);
      paint({middle, turn, half_px, 0.5, uniform(70, 185)});
    }
  }
  /// Twigs with needles on both sides, out from one edge.
  void paint_needles() {
    for (int twig = -2; twig <= 2; ++twig)
      for (int needle = 0; needle < 80; ++needle) {
        const double side = needle % 2 == 0 ? 1 : -1, share = uniform(0, 1);
        const Vector2d middle(6 + 112 * share, 64 + twig * (6 + 19 * share) + side * 6);
        const double turn = side * 1.0 + 0.15 * twig + uniform(-0.3, 0.3);
        paint({middle, turn, uniform(7, 12), 0.12, uniform(70, 170)});
      }
  }
  void paint_twig(const Vector2d& from, double turn, double length_px, int depth) {
    const Vector2d to = from + length_px * Vector2d(std::cos(turn), std::sin(turn));
    paint({0.5 * (from + to), turn, 0.5 * length_px, 0.012 * depth, uniform(80, 130)});
    if (depth == 0) return;
    for (const double side : {-1.0, 1.0})
      paint_twig(to, turn + side * uniform(0.25, 0.6), length_px * uniform(0.7, 0.85), depth - 1);
    if (depth > 2) paint_twig(0.5 * (from + to), turn + uniform(-1, 1), 0.6 * length_px, depth - 2);
  }
  /// One frond: leaflets on both sides of a stem, shorter towards the tip.
  void paint_frond(const Vector2d& foot, double lean_rad, double length_px, int leaflets) {
    const Vector2d along(std::sin(lean_rad), std::cos(lean_rad)), aside(along.y(), -along.x());
    const double turn = 0.5 * std::numbers::pi - lean_rad;
    paint({foot + 0.5 * length_px * along, turn, 0.5 * length_px, 0.02, 90});
    for (int i = 1; i <= leaflets; ++i) {
      const double share = static_cast<double>(i) / leaflets;
      const double half_px =
          0.5 * length_px * 0.42 * std::sin(std::numbers::pi * std::pow(1 - share, 0.7)) + 2;
      for (const double side : {-1.0, 1.0})
        paint({foot + share * 0.96 * length_px * along + side * 0.85 * half_px * aside, turn - side * 1.1,
               half_px, 0.22, uniform(85, 180)});
    }
  }
  void paint_fern() {
    for (const int frond : {-3, 3, -2, 2, -1, 1, 0})
      paint_frond({64.0 + 2 * frond, 2}, 0.3 * frond, 112 - 12 * std::abs(frond), 16);
  }
  void paint_grass() {
    for (int blade = 0; blade < 46; ++blade) {
      const double lean = uniform(-0.55, 0.55), length_px = uniform(50, 118) * std::cos(lean);
      const Vector2d foot(64 + uniform(-26, 26), 0);
      paint({foot + 0.5 * length_px * Vector2d(std::sin(lean), std::cos(lean)), 0.5 * std::numbers::pi - lean,
             0.5 * length_px, 0.035, uniform(80, 180)});
    }
  }
  /// Leaves, dense below and ragged above.
  void paint_thicket() {
    for (int leaf = 0; leaf < 620; ++leaf) {
      const double x = uniform(2, 126), top = 70 + 26 * std::sin(0.09 * x) + 18 * std::sin(0.23 * x + 1);
      const double y = top * (1 - std::pow(uniform(0, 1), 1.5));
      const double shade = uniform(60, 120) + 50 * y / 115;
      paint({{x, y}, uniform(0, 2 * std::numbers::pi), uniform(3, 6), 0.5, shade});
    }
  }

  std::mt19937_64 generator_;
  WoodsPicture picture_{4 * cell_px, 2 * cell_px,
                        std::vector<std::uint8_t>(std::size_t{32} * cell_px * cell_px)};
  int left_ = 0, low_ = 0;
};

/// Litter, twice along the tile, under patches of sun: one texel a fragment instead of two.
WoodsPicture ground_picture(std::uint32_t seed, double overcast) {
  const GrayTexture litter = make_texture({512, 512, 128, 0.34, 8, 7, 1.0, false, seed + 16});
  const WoodsPicture dapple = dapple_picture(seed, overcast);
  constexpr int size_px = 1024;
  const int scale = size_px / dapple.width_px;
  WoodsPicture ground{size_px, size_px, std::vector<std::uint8_t>(std::size_t{4} * size_px * size_px)};
  const auto sun_at = [&](int x, int y) {
    const auto wrapped = [&](int i) { return i & (dapple.width_px - 1); };
    return static_cast<double>(
        dapple.rgba[static_cast<std::size_t>(4 * (wrapped(y) * dapple.width_px + wrapped(x)))]);
  };
  for (int y = 0; y < size_px; ++y)
    for (int x = 0; x < size_px; ++x) {
      const double u = static_cast<double>(x % scale) / scale, v = static_cast<double>(y % scale) / scale;
      const double low = (1 - u) * sun_at(x / scale, y / scale) + u * sun_at(x / scale + 1, y / scale),
                   high =
                       (1 - u) * sun_at(x / scale, y / scale + 1) + u * sun_at(x / scale + 1, y / scale + 1);
      const double level =
          litter.gray[static_cast<std::size_t>((y % 512) * 512 + x % 512)] * ((1 - v) * low + v * high) / 128;
      std::uint8_t* rgba = ground.rgba.data() + std::size_t{4} * (y * size_px + x);
      for (int i = 0; i < 3; ++i) rgba[i] = static_cast<std::uint8_t>(std::min(level, 255.0));
      rgba[3] = 255;
    }
  return ground;
}

}  // namespace

WoodsPicture woods_picture(WoodsTexture which, std::uint32_t seed, double overcast) {
  if (which == WoodsTexture::leaves) return LeafPainter(seed).paint();
  if (which == WoodsTexture::ground) return ground_picture(seed, overcast);
  if (which == WoodsTexture::windows) {
    GrayTexture facade = facade_texture(seed);
    std::ranges::reverse(facade.gray);  // its rows begin at the top; left and right are alike
    return picture_of(facade);
  }
  const auto index = static_cast<std::size_t>(which);
  const std::array<TextureRequest, 5> requests{
      {{128, 256, 128, 0.36, 2, 6, 2.6, true},     // oak: deep fissures
       {128, 256, 134, 0.14, 2, 6, 0.8, false},    // beech: smooth, blotched
       {128, 256, 140, 0.26, 2, 6, 0.35, true},    // birch: dark bands across
       {128, 256, 128, 0.30, 3, 5, 1.6, true},     // pine: plates
       {128, 256, 128, 0.26, 4, 5, 1.1, false}}};  // spruce: scales
  TextureRequest request = requests[index];
  request.seed = seed + 11 + index;
  return picture_of(make_texture(request));
}

WoodsPicture dapple_picture(std::uint32_t seed, double overcast) {
  GrayTexture gray = make_texture({256, 256, 128, 0.5, 6, 4, 1.0, false, seed + 21u});
  for (std::uint8_t& level : gray.gray) {
    const double share = std::clamp((level - 140.0) / 50.0, 0.0, 1.0);
    const double sunny = 104 + 120 * share * share * (3 - 2 * share);
    level = static_cast<std::uint8_t>(128 + (1 - overcast) * (sunny - 128));
  }
  return picture_of(gray);
}

}  // namespace understory
