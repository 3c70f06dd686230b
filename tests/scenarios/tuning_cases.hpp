#pragma once

#include <gtest/gtest.h>

#include <filesystem>
#include <string>

#include "scenarios/tuning/tune_file.hpp"
#include "tests/support/temporary_folder.hpp"
#include "tests/support/text.hpp"

/// Tunings of the library's forest, for the tests of tuning.
namespace understory {

namespace fs = std::filesystem;
using namespace support;

inline fs::path in_library(const std::string& name) {
  const fs::path file = fs::path(UNDERSTORY_SOURCE_DIR) / "scenarios" / "library" / (name + ".yaml");
  if (!fs::exists(file)) throw ScenarioError(name + ": expected one of the library");
  return file;
}

inline const std::string two_keys =
    "scenario: forest\n"
    "parameters:\n"
    "  perception.pushbroom.minimum_edge_sum: {from: 100, to: 900}\n"
    "  perception.pushbroom.score_limit: {from: 0.05, to: 0.4, scale: log}\n";
inline const std::string over_flights = "over: flights\ntraining: 1000..1003\nvalidation: 1010..1013\n";

inline std::string tuning_text(const std::string& search = "{method: cma_es, trials: 60, seed: 2}") {
  return two_keys + "objective: {maximize: mean_speed_mps, at_least: {success: 0.5}}\nsearch: " + search +
         "\n" + over_flights;
}

struct TuningTest : testing::Test {
  support::TemporaryFolder folder;

  TuneFile load(const std::string& text) { return load_tune_file(folder.write("t.yaml", text), in_library); }
  std::string refusal_of(const std::string& text) {
    return support::refusal_of([&] { load(text); });
  }
  fs::path results(const std::string& name) const {
    fs::create_directories(folder.path() / name);
    return folder.path() / name;
  }
};

}  // namespace understory
