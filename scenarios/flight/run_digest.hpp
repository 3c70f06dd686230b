#pragma once

#include <Eigen/Geometry>
#include <cstddef>
#include <cstdint>
#include <span>
#include <string>

namespace understory {

/// A running 64-bit hash of everything a flight produced, bit for bit. Equal scenario, seed and binary give
/// equal digests on one machine. Eight bytes at a time are folded in by splitmix64's mixer (Steele, Lea &
/// Flood 2014): not cryptographic, but every bit of every word reaches every bit of the result. Images go
/// into eight chains side by side, the words in turn, which are then folded in themselves.
class RunDigest {
 public:
  void add(std::uint64_t word);
  void add(double value);
  void add(const Eigen::Isometry3d& pose);
  void add(std::span<const std::byte> bytes);
  std::string hex() const;

 private:
  std::uint64_t state_ = 0x6a09e667f3bcc908u;
};

}  // namespace understory
