#pragma once

#include <cstddef>
#include <cstdint>
#include <random>
#include <vector>

namespace understory {

/// `count` (even) draws of libstdc++'s std::normal_distribution of mean 0 and this deviation, each rounded by
/// std::lround and cut to -127..127: the same numbers from the same draws of the generator, at less than half
/// the time. Every flight with image noise draws half a million at its start.
std::vector<std::int8_t> rounded_gaussians(std::size_t count, double deviation, std::mt19937_64& generator);

}  // namespace understory
