#include "scenarios/output/program_digest.hpp"

#include <fstream>
#include <iterator>
#include <span>

#include "scenarios/flight/run_digest.hpp"

namespace understory {

std::string program_digest() {
  RunDigest digest;
  std::ifstream stream("/proc/self/exe", std::ios::binary);
  const std::string binary{std::istreambuf_iterator<char>(stream), {}};
  digest.add(std::as_bytes(std::span(binary)));
  return digest.hex();
}

}  // namespace understory
