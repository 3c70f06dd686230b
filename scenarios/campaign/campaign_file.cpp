#include "scenarios/campaign/campaign_file.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <set>

#include "perception/io/text_table.hpp"
#include "scenarios/config/config_tree.hpp"
#include "scenarios/config/keys.hpp"
#include "scenarios/scenario/scenario_io.hpp"

namespace understory {
namespace {

namespace fs = std::filesystem;

constexpr std::size_t maximum_flights = 200'000, maximum_conditions = 2'000;

const std::string the_seeds = "the seeds to fly, for instance 1..200";
const std::string seeds_decide = "no seed here: each flight has one of the campaign's seeds";

using Changes = std::vector<ConfigNode>;  ///< a tree per key

struct Override {
  std::string name;
  std::vector<std::string> with;
  ConfigNode set;
};

void visit_fields(FieldVisitor& visit, Override& one) {
  visit("name", one.name);
  visit("with", one.with, "a file of keys, or a list of such");
  visit("set", one.set);
}

/// The file as it stands.
struct CampaignText {
  std::string name;
  std::vector<std::string> scenario, scenarios, seeds;
  std::vector<Override> overrides;
  ConfigNode grid;
  double timeout_s = Campaign().timeout_s;
  int seeds_apart = 0;
};

void visit_fields(FieldVisitor& visit, CampaignText& text) {
  visit("name", text.name);
  visit("scenario", text.scenario, "the name or file of a scenario");
  visit("scenarios", text.scenarios, "names or files of scenarios");
  visit("seeds", text.seeds, the_seeds);
  visit("overrides", text.overrides);
  visit("grid", text.grid);
  visit("timeout_s", text.timeout_s, 1, 86400);
  visit("seeds_apart", text.seeds_apart, 0, 1'000'000);
}

/// A condition's changes to its scenario.
struct Variant {
  std::string name;  ///< of the overrides; empty: the scenario as it is
  Changes changes;
  std::vector<std::pair<std::string, std::string>> grid = {};
};

/// "forest.length_m" and its value, or groups of them.
void add_changes(const ConfigNode& map, const std::string& prefix, Changes& changes) {
  for (const ConfigNode& node : map.children) {
    if (node.kind == ConfigNode::Kind::map)
      add_changes(node, prefix + node.key + ".", changes);
    else
      changes.push_back(under_keys(node, prefix + node.key));
  }
}

std::string joined(const std::string& name, const std::string& more) {
  return name.empty() || more.empty() ? name + more : name + "-" + more;
}

std::string text_of(const ConfigNode& value) {
  if (value.kind == ConfigNode::Kind::scalar) return value.text;
  std::vector<std::string> parts;
  for (const ConfigNode& part : value.children) parts.push_back(text_of(part));
  return fmt::format("{}", fmt::join(parts, "_"));
}

/// Beside the campaign's file, or where it says.
fs::path beside_or_as_said(const std::string& word, const fs::path& campaign_file) {
  std::error_code ignored;
  const fs::path beside = campaign_file.parent_path() / word;
  return fs::is_regular_file(beside, ignored) ? beside : fs::path(word);
}

std::vector<Variant> overrides_of(const CampaignText& text, const ConfigNode& top,
                                  const fs::path& campaign_file, std::vector<fs::path>& files) {
  if (find_child(top, "overrides") == nullptr) return {{}};
  if (text.overrides.empty()) refuse_key(top, "overrides", "a list [{name: ..., set: {key: value}}, ...]");
  std::vector<Variant> variants;
  for (const Override& one : text.overrides) {
    const std::string here = fmt::format("overrides[{}]", variants.size());
    if (!is_plain_name(one.name)) refuse_key(top, here + ".name", "a name of letters, digits and . _ = -");
    Variant variant{one.name, {}};
    for (const std::string& word : one.with)
      variant.changes.push_back(
          parse_config_file(files.emplace_back(beside_or_as_said(word, campaign_file))));
    if (one.set.kind != ConfigNode::Kind::nothing && one.set.kind != ConfigNode::Kind::map)
      refuse_key(top, here + ".set", "a group {key: value, ...}");
    if (find_child(one.set, "seed") != nullptr) refuse_key(top, here + ".set.seed", seeds_decide);
    add_changes(one.set, "", variant.changes);
    variants.push_back(std::move(variant));
  }
  return variants;
}

/// Before any is made: whether the grid's keys are a scenario's, and how many variants it makes of so many.
std::size_t require_grid(const ConfigNode& top, std::size_t variants) {
  const ConfigNode* grid = find_child(top, "grid");
  if (grid == nullptr) return variants;
  if (grid->kind != ConfigNode::Kind::map || grid->children.empty())
    refuse_key(top, "grid", "a group {key: [values], ...}");
  std::vector<std::string> known;
  for (const Key& key : keys_of(scenario_from_text("{}", "defaults"))) known.push_back(key.name);
  for (const ConfigNode& axis : grid->children) {
    const auto is_named = [&](const std::string& key) {
      return key == axis.key || key.starts_with(axis.key + ".") || key.starts_with(axis.key + "[");
    };
    if (std::ranges::none_of(known, is_named))
      refuse_input(axis.origin, "grid." + axis.key, "unknown key" + did_you_mean(axis.key, known));
    if (axis.key == "seed") refuse_input(axis.origin, "grid.seed", "expected " + seeds_decide);
    if (axis.kind != ConfigNode::Kind::list || axis.children.empty())
      refuse_input(axis.origin, "grid." + axis.key, "expected a list of values");
    variants *= axis.children.size();
    if (variants > maximum_conditions)
      refuse_key(top, "grid", fmt::format("at most {} conditions in all", maximum_conditions));
  }
  return variants;
}

/// Conditions are named after the grid's values, so nothing else may give these keys.
void require_unset(const ConfigNode& grid, const std::vector<Variant>& overrides,
                   const std::vector<ConfigNode>& over) {
  for (const ConfigNode& axis : grid.children) {
    std::string place = origin_of(over, axis.key);
    for (const Variant& variant : overrides)
      if (place.empty()) place = origin_of(variant.changes, axis.key);
    if (!place.empty())
      refuse_input(place, axis.key, fmt::format("the grid varies this key ({}): leave it out", axis.origin));
  }
}

/// "forest-blind-cruise_speed_mps=10".
std::string name_of(const std::string& scenario, const Variant& variant) {
  std::string name = joined(scenario, variant.name);
  for (const auto& [key, value] : variant.grid) name = joined(name, plain_name(short_key(key) + "=" + value));
  return name;
}

/// Every combination of the grid's values over each of `variants`.
std::vector<Variant> with_grid(std::vector<Variant> variants, const ConfigNode& grid) {
  for (const ConfigNode& axis : grid.children) {
    std::vector<Variant> more;
    for (const Variant& variant : variants)
      for (const ConfigNode& value : axis.children) {
        Variant next = variant;
        next.grid.emplace_back(axis.key, text_of(value));
        next.changes.push_back(under_keys(value, axis.key));
        more.push_back(std::move(next));
      }
    variants = std::move(more);
  }
  return variants;
}

std::uint64_t seed_of(std::string_view word, const std::string& where, const std::string& whole) {
  const auto seed = number_in<std::uint64_t>(word);
  if (!seed || *seed > maximum_seed)
    throw ScenarioError(
        fmt::format("{}: expected first..last (1..200), a seed from 0 to 2^32, or a list of such, got '{}'",
                    where, whole));
  return *seed;
}

}  // namespace

std::vector<std::uint64_t> seeds_of(const std::vector<std::string>& ranges, const std::string& where) {
  std::vector<std::uint64_t> seeds;
  std::set<std::uint64_t> seen;
  for (const std::string& range : ranges) {
    const std::size_t dots = range.find("..");
    const std::uint64_t first = seed_of(std::string_view(range).substr(0, dots), where, range);
    const std::uint64_t last =
        dots == std::string::npos ? first : seed_of(std::string_view(range).substr(dots + 2), where, range);
    if (last < first) throw ScenarioError(fmt::format("{}: '{}' ends before it begins", where, range));
    if (last - first >= maximum_flights - std::min(seeds.size(), maximum_flights - 1))
      throw ScenarioError(fmt::format("{}: a campaign may have at most {} flights", where, maximum_flights));
    for (std::uint64_t seed = first; seed <= last; ++seed) {
      if (!seen.insert(seed).second)
        throw ScenarioError(fmt::format("{}: seed {} is given twice", where, seed));
      seeds.push_back(seed);
    }
  }
  return seeds;
}

std::string name_or_stem(const std::string& name, const ConfigNode& top, const fs::path& file) {
  if (find_child(top, "name") == nullptr) {
    const std::string stem = plain_name(file.stem().string());
    return stem.starts_with('.') ? "_" + stem : stem.substr(0, 200);
  }
  if (!is_plain_name(name)) refuse_key(top, "name", "letters, digits and . _ = -");
  return name;
}

std::vector<std::uint64_t> seeds_in(const std::vector<std::string>& words, const ConfigNode& top,
                                    const std::string& key) {
  if (words.empty()) refuse_key(top, key, the_seeds);
  return seeds_of(words, nearest_origin(top, key) + ": " + key);
}

fs::path scenario_beside(const fs::path& file, const ConfigNode& top, const std::string& key,
                         const std::string& word, const FindScenario& find_scenario) {
  std::error_code ignored;
  const fs::path beside = file.parent_path() / word;
  if (fs::is_regular_file(beside, ignored)) return beside;
  try {
    return find_scenario(word);
  } catch (const ScenarioError& error) {
    refuse_key_since(top, key, error.what());
  }
}

Campaign load_campaign(const fs::path& file, const FindScenario& find_scenario,
                       const std::vector<ConfigNode>& over,
                       const std::function<void(std::size_t done, std::size_t of)>& on_condition) {
  const ConfigNode top = parse_config_file(file);
  CampaignText text;
  read_config(top, text);
  Campaign campaign;
  campaign.name = name_or_stem(text.name, top, file);
  campaign.files.push_back(file);
  campaign.timeout_s = text.timeout_s;
  const std::string key = text.scenario.empty() ? "scenarios" : "scenario";
  const std::vector<std::string>& words = text.scenario.empty() ? text.scenarios : text.scenario;
  if (text.scenario.empty() == text.scenarios.empty())
    refuse_key(top, "scenarios", "the scenarios to fly, once: [forest, dense]");
  campaign.seeds = seeds_in(text.seeds, top, "seeds");
  const auto apart = static_cast<std::uint64_t>(text.seeds_apart);
  const std::uint64_t range = std::ranges::max(campaign.seeds) - std::ranges::min(campaign.seeds);
  if (apart > 0 && (range >= apart || std::ranges::max(campaign.seeds) + apart * words.size() > maximum_seed))
    refuse_key(
        top, "seeds_apart",
        fmt::format("more than the {} seeds from the first to the last, and no seed over 2^32", range + 1));

  std::vector<Variant> overrides = overrides_of(text, top, file, campaign.files);
  const std::size_t conditions = words.size() * require_grid(top, overrides.size());
  if (conditions > maximum_conditions)
    refuse_key(top, key, fmt::format("at most {} conditions in all", maximum_conditions));
  if (conditions * campaign.seeds.size() > maximum_flights)
    refuse_key(top, "seeds",
               fmt::format("at most {} flights in all, these are {}", maximum_flights,
                           conditions * campaign.seeds.size()));
  require_unset(text.grid, overrides, over);
  std::vector<Variant> variants = with_grid(std::move(overrides), text.grid);
  for (const ConfigNode& tree : over) {
    if (find_child(tree, "seed") != nullptr) refuse_key(tree, "seed", seeds_decide);
    for (Variant& variant : variants) variant.changes.push_back(tree);
  }
  std::set<std::string> seen;
  std::uint64_t scenario_index = 0;
  for (const std::string& word : words) {
    const fs::path path = scenario_beside(file, top, key, word, find_scenario);
    campaign.files.push_back(path);
    for (const Variant& variant : variants) {
      const Scenario scenario = load_changed_scenario(path, variant.changes);
      const std::string name = name_of(plain_name(path.stem().string()), variant);
      if (!is_plain_name(name))
        refuse_key(
            top, key,
            fmt::format("names of conditions of at most 200 characters, no '.' first; '{}' comes out", name));
      if (!seen.insert(name).second)
        refuse_key_since(top, key, fmt::format("two conditions are called '{}'", name));
      campaign.conditions.push_back({name, scenario_to_text(scenario), plain_name(path.stem().string()),
                                     variant.name, variant.grid, apart * scenario_index});
      if (on_condition) on_condition(campaign.conditions.size(), conditions);
    }
    ++scenario_index;
  }
  return campaign;
}

}  // namespace understory
