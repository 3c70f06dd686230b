#include "scenarios/flight/run_digest.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <bit>
#include <cstring>

namespace understory {

namespace {

std::uint64_t mixed(std::uint64_t state, std::uint64_t word) {
  std::uint64_t mixed = (state ^ word) + 0x9e3779b97f4a7c15u;
  mixed = (mixed ^ (mixed >> 30)) * 0xbf58476d1ce4e5b9u;
  mixed = (mixed ^ (mixed >> 27)) * 0x94d049bb133111ebu;
  return mixed ^ (mixed >> 31);
}

std::uint64_t word_at(const std::byte* bytes) {
  std::uint64_t word = 0;
  std::memcpy(&word, bytes, sizeof word);
  return word;
}

}  // namespace

void RunDigest::add(std::uint64_t word) { state_ = mixed(state_, word); }

void RunDigest::add(double value) { add(std::bit_cast<std::uint64_t>(value)); }

void RunDigest::add(const Eigen::Isometry3d& pose) {
  for (Eigen::Index column = 0; column < 4; ++column) {
    for (Eigen::Index row = 0; row < 3; ++row) add(pose.matrix()(row, column));
  }
}

void RunDigest::add(std::span<const std::byte> bytes) {
  constexpr std::size_t word_bytes = sizeof(std::uint64_t);
  add(static_cast<std::uint64_t>(bytes.size()));
  // Each word waits for the one before it. Eight chains side by side take a fifth of the time of one.
  std::array<std::uint64_t, 8> chains{1, 2, 3, 4, 5, 6, 7, 8};
  constexpr std::size_t round_bytes = chains.size() * word_bytes;
  std::size_t at = 0;
  for (; at + round_bytes <= bytes.size(); at += round_bytes)
    for (std::size_t chain = 0; chain < chains.size(); ++chain)
      chains[chain] = mixed(chains[chain], word_at(bytes.data() + at + chain * word_bytes));
  for (const std::uint64_t chain : chains) add(chain);
  for (; at < bytes.size(); at += word_bytes) {
    std::array<std::byte, word_bytes> last{};
    std::copy_n(bytes.data() + at, std::min(word_bytes, bytes.size() - at), last.data());
    add(word_at(last.data()));
  }
}

std::string RunDigest::hex() const { return fmt::format("{:016x}", state_); }

}  // namespace understory
