#include <benchmark/benchmark.h>

#include <cstddef>
#include <filesystem>

#include "perception/io/calibration_file.hpp"
#include "scenarios/bench/bench.hpp"

/// The rows of `understory bench` on the long rig's raw cameras, 64 rendered pairs in turn, none twice.
/// Ratios to the yardsticks are `understory bench`'s to print: it lets the cases take turns.
int main(int argc, char** argv) {
  benchmark::Initialize(&argc, argv);
  if (benchmark::ReportUnrecognizedArguments(argc, argv)) return 2;
  const auto rig = understory::read_calibrated_rig(
      std::filesystem::path(UNDERSTORY_SOURCE_DIR) / "models/rigs/raw/long.xml", {});
  const auto pairs = understory::bench_pairs(rig, understory::stereo_scenes(rig, 64, 1));
  auto cases = understory::bench_cases(rig, pairs);
  for (auto& one : cases)
    benchmark::RegisterBenchmark(one.name.c_str(),
                                 [&](benchmark::State& state) {
                                   std::size_t pair = 0;
                                   for (auto _ : state) {
                                     one.run(pair);
                                     pair = (pair + 1) % pairs.delivered.size();
                                   }
                                 })
        ->Unit(benchmark::kMillisecond)
        ->UseRealTime();
  benchmark::RunSpecifiedBenchmarks();
}
