#include <gtest/gtest.h>

#include <filesystem>
#include <nlohmann/json.hpp>
#include <random>
#include <string>
#include <vector>

#include "tests/misuse/misuse_table.hpp"
#include "tests/support/program.hpp"
#include "tests/support/temporary_folder.hpp"

/// Every JSON file that the program writes, damaged in drawn ways, and every command that reads it: none ends
/// in an internal fault, a crash or more than one line.
namespace understory::support {
namespace {

namespace fs = std::filesystem;
using Json = nlohmann::ordered_json;

/// All places in a value.
void collect_places(Json& json, std::vector<Json*>& places) {
  places.push_back(&json);
  if (json.is_structured())
    for (Json& child : json) collect_places(child, places);
}

/// A value of every type, some of them at the edge of what fits.
Json drawn_value(std::mt19937_64& generator) {
  const std::vector<Json> values{nullptr,
                                 true,
                                 -1,
                                 1e300,
                                 18446744073709551615U,
                                 "",
                                 "goal",
                                 "../../x",
                                 std::string(5000, 'x'),
                                 Json::array(),
                                 Json::object(),
                                 Json::array({1, "a", nullptr}),
                                 Json::object({{"a", 1}})};
  return values[generator() % values.size()];
}

std::string damaged(const std::string& text, std::mt19937_64& generator) {
  std::string bytes = text;
  switch (generator() % 6) {
    case 0:  // torn
      return text.substr(0, generator() % (text.size() + 1));
    case 1:  // a byte of another kind
      bytes[generator() % bytes.size()] = static_cast<char>(generator() % 256);
      return bytes;
    case 2:  // a piece twice
      return text.substr(0, generator() % text.size()) + text.substr(generator() % text.size());
    default: {  // a value of another type, or gone
      const std::size_t end = text.find('\n');
      const bool has_lines = Json::accept(text.substr(0, end)) && end + 1 < text.size();
      Json json = Json::parse(has_lines ? text.substr(0, end) : text, nullptr, false);
      if (json.is_discarded()) return "";
      std::vector<Json*> places;
      collect_places(json, places);
      Json& place = *places[generator() % places.size()];
      if (place.is_object() && !place.empty() && generator() % 2 == 0)
        place.erase(std::next(place.begin(), static_cast<std::ptrdiff_t>(generator() % place.size())));
      else
        place = drawn_value(generator);
      return json.dump() + (has_lines ? text.substr(end) : "");
    }
  }
}

struct Reader {
  std::string file;
  std::vector<std::string> commands;
};

TEST(DamagedJson, OfEveryKindIsReadToOneLineAtMost) {
  const TemporaryFolder folder;
  Fixtures fixtures(folder.path() / "fixtures");
  fs::create_directories(fixtures.folder());
  fixtures.make_those_in("$F/run $F/campaign $F/tuning");
  const std::string at = fixtures.folder().string() + "/";
  const std::vector<Reader> readers{
      {"campaign/campaign.json",
       {"collect " + at + "campaign", "report " + at + "campaign --quiet",
        "shard " + at + "campaign --number 0 --of 1",
        "campaign " + at + "campaign.yaml --resume --print-tasks --out " + at + "campaign"}},
      {"campaign/flights/clear-short-1.json",
       {"collect " + at + "campaign", "report " + at + "campaign --quiet",
        "campaign " + at + "campaign.yaml --resume --print-tasks --out " + at + "campaign"}},
      {"run/result.json", {"report " + at + "run --no-video --quiet"}},
      {"tuning/tune.json", {"tune " + at + "tune.yaml --resume --out " + at + "tuning"}},
      {"tuning/trials.jsonl", {"tune " + at + "tune.yaml --resume --out " + at + "tuning"}},
  };
  std::mt19937_64 generator(7);
  for (const Reader& reader : readers) {
    const std::string whole = content_of(at + reader.file);
    ASSERT_FALSE(whole.empty()) << reader.file;
    for (int i = 0; i < 10; ++i) {
      const std::string text = damaged(whole, generator);
      for (const std::string& command : reader.commands) {
        std::ofstream(at + reader.file, std::ios::binary | std::ios::trunc) << text;
        const ProgramRun outcome = understory(command, "", "2>&1 >/dev/null");
        EXPECT_TRUE(outcome.status >= 0 && outcome.status <= 3) << outcome.status << " " << command << "\n"
                                                                << text;
        EXPECT_EQ(outcome.text.find("internal fault"), std::string::npos) << command << "\n"
                                                                          << outcome.text << text;
        EXPECT_LE(std::count(outcome.text.begin(), outcome.text.end(), '\n'), 1) << outcome.text;
      }
    }
    std::ofstream(at + reader.file, std::ios::binary | std::ios::trunc) << whole;
  }
}

}  // namespace
}  // namespace understory::support
