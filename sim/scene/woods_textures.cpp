#include "sim/scene/woods_textures.hpp"

#include <Eigen/Core>
#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>
#include <random>

#include "sim/scene/textures.hpp"

namespace understory {
namespace {

using Eigen::Vector2d;

WoodsPicture picture_of(const GrayTexture& gray) {
  WoodsPicture picture{gray.width_px, gray.height_px, {}};
  for (const std::uint8_t level : gray.gray)
    for (int i = 0; i < 4; ++i) picture.rgba.push_back(i < 3 ? level : 255);
  return picture;
}

/// An ellipse with pointed ends, within its own quarter of the picture.
void paint_leaf(WoodsPicture& picture, const Vector2d& centre, double turn, double half_px, double width,
                double gray) {
  const int left = static_cast<int>(centre.x()) / 128 * 128, low = static_cast<int>(centre.y()) / 128 * 128;
  const Vector2d along(std::cos(turn), std::sin(turn));
  for (int y = std::max(low, static_cast<int>(centre.y() - half_px));
       y < std::min(low + 128.0, centre.y() + half_px + 1); ++y)
    for (int x = std::max(left, static_cast<int>(centre.x() - half_px));
         x < std::min(left + 128.0, centre.x() + half_px + 1); ++x) {
      const Vector2d offset = Vector2d(x + 0.5, y + 0.5) - centre;
      const double a = offset.dot(along) / half_px;
      const double b = (along.x() * offset.y() - along.y() * offset.x()) / half_px;
      if (std::abs(a) >= 1 || std::abs(b) > width * (1 - a * a)) continue;
      const double level = gray * (std::abs(b) < 0.06 ? 1.15 : 1);
      std::uint8_t* rgba = picture.rgba.data() + 4 * (y * picture.width_px + x);
      for (int i = 0; i < 3; ++i) rgba[i] = static_cast<std::uint8_t>(std::min(level, 255.0));
      rgba[3] = 255;
    }
}

class LeafPainter {
 public:
  explicit LeafPainter(std::uint32_t seed) : generator_(seed) {
    for (std::size_t i = 0; i < picture_.rgba.size(); ++i) picture_.rgba[i] = i % 4 == 3 ? 0 : 100;
  }
  WoodsPicture paint() {
    paint_spray(0), paint_spray(1);
    paint_needles();
    paint_fern();
    return std::move(picture_);
  }

 private:
  double uniform(double low, double high) {
    return low + (high - low) * std::uniform_real_distribution<double>(0, 1)(generator_);
  }
  void paint_spray(int column) {
    for (int leaf = 0; leaf < 130; ++leaf) {
      const double out = 54 * std::sqrt(uniform(0, 1)), angle = uniform(0, 2 * std::numbers::pi);
      const Vector2d place(column * 128 + 64 + out * std::cos(angle), 64 + out * std::sin(angle));
      const double turn = uniform(0, 2 * std::numbers::pi), half_px = uniform(6, 10);
      paint_leaf(picture_, place, turn, half_px, 0.5, uniform(70, 185));
    }
  }
  void paint_needles() {
    for (int twig = -2; twig <= 2; ++twig)
      for (int needle = 0; needle < 70; ++needle) {
        const double side = needle % 2 == 0 ? 1 : -1;
        const Vector2d place(64 + uniform(-58, 58), 128 + 64 + twig * 22 + side * 8);
        const double turn = side * 1.2 + uniform(-0.3, 0.3), half_px = uniform(8, 13);
        paint_leaf(picture_, place, turn, half_px, 0.14, uniform(70, 170));
      }
  }
  void paint_fern() {
    for (int frond = -4; frond <= 4; ++frond) {
      const double lean = frond * 0.28;
      for (int leaf = 0; leaf < 26; ++leaf) {
        const Vector2d place =
            Vector2d(128 + 64, 128 + 4) + 4.4 * leaf * Vector2d(std::sin(lean), std::cos(lean));
        for (const double side : {-1.0, 1.0})
          paint_leaf(picture_, place + side * 5 * Vector2d(std::cos(lean), -std::sin(lean)),
                     0.5 * std::numbers::pi - lean - side * 0.9, 4 + 5 * std::sin(0.12 * leaf), 0.35,
                     uniform(80, 180));
      }
    }
  }

  std::mt19937_64 generator_;
  WoodsPicture picture_{256, 256, std::vector<std::uint8_t>(256 * 256 * 4)};
};

}  // namespace

WoodsPicture woods_picture(WoodsTexture which, std::uint32_t seed) {
  if (which == WoodsTexture::leaves) return LeafPainter(seed).paint();
  const auto index = static_cast<std::size_t>(which);
  const std::array<TextureRequest, 6> requests{
      {{128, 256, 128, 0.36, 2, 6, 2.6, true},     // oak: deep fissures
       {128, 256, 134, 0.14, 2, 6, 0.8, false},    // beech: smooth, blotched
       {128, 256, 140, 0.26, 2, 6, 0.35, true},    // birch: dark bands across
       {128, 256, 128, 0.30, 3, 5, 1.6, true},     // pine: plates
       {128, 256, 128, 0.26, 4, 5, 1.1, false},    // spruce: scales
       {512, 512, 128, 0.34, 4, 7, 1.0, false}}};  // litter
  TextureRequest request = requests[index];
  request.seed = seed + 11 + index;
  return picture_of(make_texture(request));
}

WoodsPicture dapple_picture(std::uint32_t seed) {
  GrayTexture gray = make_texture({256, 256, 128, 0.5, 6, 4, 1.0, false, seed + 21u});
  for (std::uint8_t& level : gray.gray) {
    const double share = std::clamp((level - 140.0) / 50.0, 0.0, 1.0);
    level = static_cast<std::uint8_t>(104 + 120 * share * share * (3 - 2 * share));
  }
  return picture_of(gray);
}

}  // namespace understory
