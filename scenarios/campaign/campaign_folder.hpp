#pragma once

#include <cstdint>
#include <filesystem>
#include <optional>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "scenarios/campaign/flight_row.hpp"
#include "scenarios/output/folder_mark.hpp"
#include "scenarios/output/program.hpp"
#include "scenarios/recording/recording_choice.hpp"

namespace understory {

/// One way to fly: a scenario with its overrides.
struct Condition {
  std::string name;  ///< "forest-blind", "forest-cruise_speed_mps=10": letters, digits and . _ = -
  /// The effective scenario, every value written; a flight's seed replaces its own.
  std::string scenario_text;
  std::string scenario;  ///< what its file is called: "forest"
  std::string variant;   ///< name of the overrides: "blind"; empty without any
  std::vector<std::pair<std::string, std::string>> grid;  ///< keys of the grid and its values, in its order
  std::uint64_t seed_offset = 0;  ///< its flights' seeds are the campaign's and this more (seeds_apart)
};

/// What distinguishes a condition, in words: "forest, blind, raw=true"; without its scenario if that is
/// titled_scenario, and without the grid's key `but_for`.
std::string words_of(const Condition& condition, const std::string& titled_scenario,
                     std::string_view but_for = "");

/// The scenario of all conditions; empty where they have several, or there are none.
std::string scenario_of_all(const std::vector<Condition>& conditions);

/// Many flights: every seed in every condition, or with seed_offset seeds of its own in each scenario.
struct Campaign {
  std::string name;
  std::vector<Condition> conditions;
  std::vector<std::uint64_t> seeds;
  std::string renderer = "osmesa";  ///< osmesa or egl; the identity has the renderer's full name
  double timeout_s = 300;           ///< of wall time: a flight that takes longer hangs
  Identity identity;                ///< of its flights (identity_of)
  Identity pictures;   ///< scenery, and the digest of a pair of it (pictures_of); empty: of an older program
  std::string commit;  ///< of the program that began it
  RecordingChoice recording;                 ///< of every flight, in runs/ID
  std::vector<std::filesystem::path> files;  ///< that its description was read from
};

/// One flight to be flown.
struct CampaignTask {
  std::string id;  ///< "<condition>-<seed>", unique
  std::size_t condition = 0;
  std::uint64_t seed = 0;
};

/// All flights, condition by condition: the order of the rows.
std::vector<CampaignTask> tasks_of(const Campaign& campaign);
/// The same seed by seed, as they are flown: an unfinished campaign compares the same forests.
std::vector<CampaignTask> in_flying_order(const Campaign& campaign);

/// A campaign's results on disk:
///
///     campaign.json          what is flown, by which program
///     conditions/NAME.yaml   each condition's effective scenario
///     flights/ID.json        a flight's file, there once it is over; written whole or not at all
///     tracks/ID.track        a lost flight for the page: compact_flight() of flight_page.hpp
///     explained/ID.json      why a lost flight was lost, where explain has found it out
///     logs/ID.txt standard error of a flight that failed to run
///     flights.csv .jsonl     every row, in the campaign's order
///     costs.csv              wall time and memory
///
/// Only a flight's file tells that the flight is over, so nothing has to be undone after a kill or a power
/// cut, and two programs that fly the same flight write the same.
struct CampaignFolder {
  std::filesystem::path path;
  std::filesystem::path condition_file(const Condition& condition) const {
    return path / "conditions" / (condition.name + ".yaml");
  }
  std::filesystem::path flight_file(const CampaignTask& task) const {
    return path / "flights" / (task.id + ".json");
  }
  std::filesystem::path track_file(const std::string& id) const { return path / "tracks" / (id + ".track"); }
  std::filesystem::path explanation_file(const std::string& id) const {
    return path / "explained" / (id + ".json");
  }
  std::filesystem::path log_file(const CampaignTask& task) const {
    return path / "logs" / (task.id + ".txt");
  }
};

/// Makes the folder, or, with `resume`, checks that it holds this very campaign, begun by this program. With
/// `may_grow` it may have fewer seeds until now.
/// Throws ScenarioError in one line where it holds a campaign already (without `resume`), another one, one of
/// another identity or format, other files, or where it cannot be written.
void prepare_campaign_folder(FolderMark& mark, const CampaignFolder& folder, const Campaign& campaign,
                             bool resume, bool may_grow = false);

/// Throws ScenarioError where the flights of `held`, which the folder holds, began with another identity.
void require_identity(const CampaignFolder& folder, const Campaign& held, const Identity& identity);

/// Whether a campaign has left this folder.
bool holds_campaign(const std::filesystem::path& folder);

/// The campaign that a folder holds. Throws ScenarioError where it holds none or one of another format.
Campaign read_campaign(const CampaignFolder& folder);

/// The text with '_' for all but letters, digits and . _ = -, and for a first = or -.
std::string plain_name(std::string text);

/// Letters, digits and . _ = -, none of . = - first, at most 200: a name for files and tables.
bool is_plain_name(const std::string& name);

/// A file's text; nothing where it cannot be read.
std::optional<std::string> text_if_there(const std::filesystem::path& file);

/// One flight's file; nothing where it is missing or not whole.
std::optional<FlightFile> read_flight(const CampaignFolder& folder, const CampaignTask& task);
/// Writes it so that it outlives a power cut. Sets the row's id and condition.
void write_flight(const CampaignFolder& folder, const Campaign& campaign, const CampaignTask& task,
                  FlightFile file);

/// The results that are there.
struct Collected {
  std::vector<FlightRow> rows;    ///< in the campaign's order
  std::vector<FlightCost> costs;  ///< of the rows
  std::size_t missing = 0;        ///< flights without a file
};
/// Gathers the flights' files, with a progress line.
Collected gather(const CampaignFolder& folder, const Campaign& campaign);
/// The same, and writes flights.csv, flights.jsonl and costs.csv.
Collected collect(const CampaignFolder& folder, const Campaign& campaign);

/// The rows of a folder's flights.csv, wherever they were flown. Throws ScenarioError where there is none, or
/// one of another format.
std::vector<FlightRow> read_campaign_rows(const std::filesystem::path& folder);

}  // namespace understory
