#include "scenarios/run_digest.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <bit>
#include <cstring>

namespace understory {

void RunDigest::add(std::uint64_t word) {
  std::uint64_t mixed = (state_ ^ word) + 0x9e3779b97f4a7c15u;
  mixed = (mixed ^ (mixed >> 30)) * 0xbf58476d1ce4e5b9u;
  mixed = (mixed ^ (mixed >> 27)) * 0x94d049bb133111ebu;
  state_ = mixed ^ (mixed >> 31);
}

void RunDigest::add(double value) { add(std::bit_cast<std::uint64_t>(value)); }

void RunDigest::add(const Eigen::Isometry3d& pose) {
  for (Eigen::Index column = 0; column < 4; ++column) {
    for (Eigen::Index row = 0; row < 3; ++row) add(pose.matrix()(row, column));
  }
}

void RunDigest::add(std::span<const std::byte> bytes) {
  add(static_cast<std::uint64_t>(bytes.size()));
  for (std::size_t at = 0; at < bytes.size(); at += sizeof(std::uint64_t)) {
    std::uint64_t word = 0;
    std::memcpy(&word, bytes.data() + at, std::min(sizeof word, bytes.size() - at));
    add(word);
  }
}

std::string RunDigest::hex() const { return fmt::format("{:016x}", state_); }

}  // namespace understory
