#include "scenarios/explain/explanation.hpp"

#include <algorithm>
#include <map>
#include <utility>

#include "scenarios/scenario/scenario.hpp"

namespace understory {
namespace {

constexpr double small_chance = 0.2;  ///< below it there was no return
constexpr int first_look = 4, control_look = 10, parts_look = 5, close_look = 24, joint_look = 6;
constexpr double promising = 0.15;  ///< an effect that deserves a close look
constexpr int kept_back = 14;       ///< of the flights, for the question which parts act together
/// A part that sees everything can make up for most faults of others: it is the cause only where no other
/// part has this share of its effect. Detection at the depths in use comes before it, too. Among the others a
/// part that has this share of the greatest effect is the cause if the log shows its fault, and not that of
/// the greater ones: chance decides between effects so close. Where the planner found a free way each time, a
/// longer search found only a better one, and comes after sight where sight does more.
constexpr double comparable = 0.5;

std::vector<std::string> all_parts() { return {ideal_part_names.begin(), ideal_part_names.end()}; }

std::vector<std::string> all_but(const std::string& part) {
  std::vector<std::string> others = all_parts();
  std::erase(others, part);
  return others;
}

std::string name_of(const std::vector<std::string>& parts) {
  if (parts.empty()) return std::string(the_control);
  if (parts.size() == 1) return parts.front();
  std::string name(all_ideal);
  for (const std::string_view part : ideal_part_names)
    if (std::ranges::find(parts, part) == parts.end()) name += " but " + std::string(part);
  return name;
}

std::vector<Chance> chances_of(const std::vector<Redraw>& flights) {
  std::map<std::string, std::map<double, Share>> flown;
  for (const Redraw& one : flights) flown[name_of(one.parts)][one.before_end_s].count(one.survived);
  std::vector<Chance> all;
  for (const auto& [part, moments] : flown) {
    std::vector<Share> shares;
    for (const auto& [moment_s, share] : moments) shares.push_back(share);
    const std::vector<double> fitted = monotone_fit(shares);
    auto fit = fitted.begin();
    for (const auto& [moment_s, share] : moments) all.push_back({part, moment_s, share, *fit++});
  }
  return all;
}

/// The control's flight with the same noise.
const Redraw* control_of(const Explanation& result, const Redraw& redraw) {
  const auto flight = std::ranges::find_if(result.flights, [&](const Redraw& one) {
    return one.parts.empty() && one.before_end_s == redraw.before_end_s && one.seed == redraw.seed;
  });
  return flight == result.flights.end() ? nullptr : &*flight;
}

/// Over the same noise, at the decisive moments.
PairedOutcomes pairs_of(const Explanation& result, const std::string& part) {
  PairedOutcomes pairs;
  for (const double moment_s : result.decisive_s) {
    const PairedOutcomes at = pairs_at(result, part, moment_s);
    pairs.both += at.both;
    pairs.only_first += at.only_first;
    pairs.only_second += at.only_second;
    pairs.neither += at.neither;
  }
  return pairs;
}

std::vector<Effect> effects_of(const Explanation& result) {
  std::vector<Effect> all;
  for (const std::string& part : all_parts()) all.push_back({part, pairs_of(result, part)});
  all.push_back({std::string(all_ideal), pairs_of(result, std::string(all_ideal))});
  std::ranges::stable_sort(all, std::ranges::greater{}, &Effect::difference);
  return all;
}

/// One explanation while it is made.
class Inquiry {
 public:
  Inquiry(const ExplanationOptions& options, const FlyRedraws& fly) : options_(options), fly_(fly) {}

  Explanation run() {
    for (const double moment_s : options_.moments_s) ask({}, moment_s, first_look);
    answer();
    find_decisive_moments();
    while (look_at_decisive_moments()) find_decisive_moments();
    // By turns, so that a small budget leaves no part out.
    for (int count = 1; count <= parts_look; ++count)
      for (const double moment_s : result_.decisive_s) {
        ask({}, moment_s, count, parts_look);
        for (const std::string& part : all_parts()) ask({part}, moment_s, count, parts_look);
        ask(all_parts(), moment_s, count, parts_look);
      }
    answer();
    look_closely();
    decide();
    return std::move(result_);
  }

 private:
  /// Wants the first `count` redraws of these parts at this moment; those that were flown count.
  /// `kept`: so many flights are left for later questions.
  void ask(const std::vector<std::string>& parts, double before_end_s, int count, int kept = 0) {
    for (int seed = 1; seed <= count; ++seed) {
      Redraw redraw{parts, before_end_s, options_.first_seed + static_cast<std::uint64_t>(seed - 1), false};
      const auto is_it = [&](const Redraw& one) {
        return one.parts == redraw.parts && one.before_end_s == before_end_s && one.seed == redraw.seed;
      };
      if (std::ranges::any_of(result_.flights, is_it) || std::ranges::any_of(asked_, is_it)) continue;
      const std::size_t so_far = result_.flights.size() + asked_.size();
      if (so_far + static_cast<std::size_t>(kept) < static_cast<std::size_t>(options_.flights))
        asked_.push_back(std::move(redraw));
    }
  }

  void answer() {
    if (!asked_.empty()) fly_(asked_);
    result_.flights.insert(result_.flights.end(), asked_.begin(), asked_.end());
    asked_.clear();
    summarise(result_);
  }

  /// The last moment from which the control seldom survives, and the one before it.
  void find_decisive_moments() {
    std::vector<double> hopeless, hopeful;
    result_.decisive_s.clear();
    for (const Chance& chance : result_.chances)
      if (chance.part == the_control)
        (chance.fitted < small_chance ? hopeless : hopeful).push_back(chance.before_end_s);
    result_.last_chance_s = hopeful.empty() ? std::nullopt : std::optional(hopeful.front());
    if (!hopeless.empty()) result_.decisive_s.push_back(hopeless.back());
    if (!hopeful.empty()) result_.decisive_s.push_back(hopeful.front());
    if (hopeful.empty() && hopeless.size() > 1)  // it had no chance all along: with some time left
      result_.decisive_s.insert(result_.decisive_s.begin(), hopeless[hopeless.size() - 2]);
  }

  /// Whether the control had to be flown more often there: then the moments may be others.
  bool look_at_decisive_moments() {
    for (const double moment_s : result_.decisive_s) ask({}, moment_s, control_look, kept_back);
    const bool is_new = !asked_.empty();
    answer();
    return is_new;
  }

  const Effect& effect_of(std::string_view part) const {
    return *std::ranges::find(result_.effects, part, &Effect::part);
  }

  /// The two parts that lead, and sight, get more flights, by turns.
  void look_closely() {
    std::vector<std::string> leading;
    for (const Effect& effect : result_.effects)
      if (effect.part != all_ideal && (effect.part == "sight" || leading.size() < 2) &&
          effect.difference() > promising)
        leading.push_back(effect.part);
    for (int count = parts_look + 1; !leading.empty() && count <= close_look; ++count)
      for (const double moment_s : result_.decisive_s) {
        ask({}, moment_s, count, kept_back);
        for (const std::string& part : leading) ask({part}, moment_s, count, kept_back);
      }
    answer();
  }

  /// The part with the greatest effect that is told from zero, or a comparable one that the log shows; sight
  /// where none of the others compares with it.
  const Effect* best_part(const std::vector<std::string>& shown) const {
    const Effect& sight = effect_of("sight");
    const double of_sight = sight.is_told_from_zero() ? sight.difference() : 0;
    const Effect* best = nullptr;
    for (const Effect& effect : result_.effects) {
      const bool is_shown = std::ranges::find(shown, effect.part) != shown.end();
      const bool had_found = effect.part == "search" && !is_shown;
      if (effect.part == all_ideal || effect.part == "sight" || !effect.is_told_from_zero() ||
          effect.difference() < comparable * of_sight || (had_found && effect.difference() <= of_sight))
        continue;
      if (best == nullptr) best = &effect;
      if (is_shown && effect.difference() >= comparable * best->difference()) return &effect;
    }
    return best != nullptr || of_sight <= 0 ? best : &sight;
  }

  void decide() {
    if (const Effect* best = best_part(options_.shown(result_.decisive_s.back()))) {
      result_.cause = best->part;
      return;
    }
    if (effect_of(all_ideal).is_told_from_zero()) {
      find_joint_parts();
      return;
    }
    ask(all_parts(), options_.moments_s.back(), joint_look);
    answer();
    const bool is_possible = survived(all_parts(), options_.moments_s.back()).value() >= 0.5;
    result_.cause = is_possible || result_.last_chance_s ? "chance" : "infeasible";
  }

  /// How many of the flights with these parts at this moment survived.
  Share survived(const std::vector<std::string>& parts, double before_end_s) const {
    Share share;
    for (const Redraw& one : result_.flights)
      if (one.parts == parts && one.before_end_s == before_end_s) share.count(one.survived);
    return share;
  }

  /// The parts without which everything else does not save it.
  void find_joint_parts() {
    result_.cause = "joint";
    const double moment_s = result_.decisive_s.front();
    for (int count = 1; count <= joint_look; ++count)
      for (const std::string& part : all_parts()) ask(all_but(part), moment_s, count);
    answer();
    const double whole = survived(all_parts(), moment_s).value();
    for (const std::string& part : all_parts()) {
      const Share without = survived(all_but(part), moment_s);
      if (without.of > 0 && without.value() < 0.5 * whole) result_.parts.push_back(part);
    }
  }

  const ExplanationOptions& options_;
  const FlyRedraws& fly_;
  std::vector<Redraw> asked_;
  Explanation result_;
};

}  // namespace

void summarise(Explanation& explanation) {
  explanation.chances = chances_of(explanation.flights);
  explanation.effects = effects_of(explanation);
}

std::vector<double> moments_of(double flown_s) {
  std::vector<double> moments;
  for (const double moment_s : {0.25, 0.5, 0.75, 1.0, 1.5, 2.0, 3.0, 4.0})
    if (moments.empty() || moment_s < flown_s - 0.2) moments.push_back(moment_s);
  return moments;
}

PairedOutcomes pairs_at(const Explanation& explanation, const std::string& part, double before_end_s) {
  PairedOutcomes pairs;
  for (const Redraw& one : explanation.flights) {
    if (one.before_end_s != before_end_s || name_of(one.parts) != part) continue;
    if (const Redraw* control = control_of(explanation, one)) pairs.count(control->survived, one.survived);
  }
  return pairs;
}

Explanation explain(const ExplanationOptions& options, const FlyRedraws& fly) {
  return Inquiry(options, fly).run();
}

std::vector<double> monotone_fit(std::span<const Share> shares) {
  struct Block {
    Share share;
    std::size_t entries = 0;
  };
  std::vector<Block> blocks;
  for (const Share& share : shares) {
    blocks.push_back({share, 1});
    const auto falls = [&] {
      const Block &last = blocks.back(), &before = blocks[blocks.size() - 2];
      return last.share.of == 0 || before.share.of == 0 || last.share.value() < before.share.value();
    };
    while (blocks.size() > 1 && falls()) {
      blocks[blocks.size() - 2].share.add(blocks.back().share);
      blocks[blocks.size() - 2].entries += blocks.back().entries;
      blocks.pop_back();
    }
  }
  std::vector<double> fitted;
  for (const Block& block : blocks) fitted.insert(fitted.end(), block.entries, block.share.value());
  return fitted;
}

}  // namespace understory
