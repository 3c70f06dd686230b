#pragma once

#include <cstdint>
#include <string_view>

namespace understory {

/// A seed of its own for every consumer of randomness: FNV-1a over the name, mixed with the flight's seed by
/// splitmix64's finaliser (Steele, Lea & Flood 2014), so that neighbouring seeds give unrelated generators
/// and adding a consumer changes no other.
constexpr std::uint64_t seed_for(std::uint64_t seed, std::string_view name) {
  std::uint64_t hash = 0xcbf29ce484222325u;
  for (const char c : name) hash = (hash ^ static_cast<unsigned char>(c)) * 0x100000001b3u;
  std::uint64_t mixed = hash + seed * 0x9e3779b97f4a7c15u;
  mixed = (mixed ^ (mixed >> 30)) * 0xbf58476d1ce4e5b9u;
  mixed = (mixed ^ (mixed >> 27)) * 0x94d049bb133111ebu;
  return mixed ^ (mixed >> 31);
}

}  // namespace understory
