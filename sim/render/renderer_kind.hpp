#pragma once

#include <array>
#include <cstddef>
#include <string_view>
#include <utility>

namespace understory {

/// Which library draws. It belongs to the machine, not to the scenario. On a CPU all draw the same bits
/// (Mesa's llvmpipe, one version). A GPU draws its own, so compare digests only between flights drawn alike.
enum class RendererKind {
  osmesa,    ///< software, through libOSMesa
  egl,       ///< a GPU where there is one, otherwise software, through libEGL
  automatic  ///< a GPU through libEGL where there is one, otherwise software: libOSMesa, or else libEGL
};

inline constexpr std::array<std::pair<std::string_view, RendererKind>, 3> renderer_names{
    {{"osmesa", RendererKind::osmesa}, {"egl", RendererKind::egl}, {"auto", RendererKind::automatic}}};

/// The word a command line uses for it.
constexpr std::string_view word_for(RendererKind kind) {
  return renderer_names[static_cast<std::size_t>(kind)].first;
}

}  // namespace understory
