#pragma once

#include <cstdint>
#include <functional>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "scenarios/statistics/statistics.hpp"

/// Why a flight was lost, as a difference of chances: flights near the limit are chaotic, so that whatever
/// touches one saves it now and then. Each part of the stack is replaced by an ideal one from a moment on,
/// again and again with other noise, beside a control in which only the noise is another. Nothing here flies:
/// whoever asks brings the flights (explain_run.hpp) or, in tests, a law of chances.
namespace understory {

/// What takes the place of the stack's own parts: one of `ideal.parts`, all of them, or none (the control).
inline constexpr std::string_view the_control = "control", all_ideal = "everything";

/// One flight: the lost one until `before_end_s` before its end, then with ideal parts and other noise.
struct Redraw {
  std::vector<std::string> parts;  ///< empty: the control
  double before_end_s = 0;
  std::uint64_t seed = 1;  ///< of the noise; the same seed and moment have the same noise, whatever the parts
  bool survived = false;   ///< was still flying, or at its goal, 2 s after the lost flight's end
  bool operator==(const Redraw&) const = default;
};

/// Flies all of them and fills in `survived`. May throw; what it throws ends the explanation.
using FlyRedraws = std::function<void(std::vector<Redraw>&)>;

/// The chance to survive from a moment on with some parts ideal.
struct Chance {
  std::string part;  ///< control, everything, or one part
  double before_end_s = 0;
  Share flown;
  double fitted = 0;  ///< by the monotone fit: who has more time left has no smaller chance
};

/// What a part would have been worth: the chance with it less the control's, over the same noise at the
/// moments around the point of no return.
struct Effect {
  std::string part;
  PairedOutcomes pairs;  ///< first: the control
  double difference() const { return pairs.difference(); }
  Interval interval() const { return paired_difference_interval(pairs); }
  bool is_told_from_zero() const { return interval().minimum > 0; }
};

struct Explanation {
  std::vector<Redraw> flights;
  std::vector<Chance> chances;
  /// The point of no return: the latest moment at which the control's fitted chance is at least one in five
  /// (before the parts were tried: the decisive moments lie around it), before the end; nothing
  /// where it is smaller at every moment that was tried.
  std::optional<double> last_chance_s;
  /// The moments whose pairs make the effects; the greatest is the last chance or, without one, the earliest.
  std::vector<double> decisive_s;
  std::vector<Effect> effects;     ///< the greatest first
  std::string cause;               ///< a part; joint, infeasible or chance
  std::vector<std::string> parts;  ///< of a joint cause: those that act together
};

/// Chances and effects, from the flights and the decisive moments.
void summarise(Explanation& explanation);

struct ExplanationOptions {
  std::vector<double> moments_s;  ///< before the end, increasing
  int flights = 170;              ///< at most so many
  std::uint64_t first_seed = 1;   ///< of the redraws: others give an independent second opinion
  /// Parts whose fault the flight's log shows, given the last chance (Explanation::decisive_s).
  std::function<std::vector<std::string>(double last_chance_s)> shown;
};

/// Moments to try for a flight that was in the air for `flown_s`.
std::vector<double> moments_of(double flown_s);

/// Of the redraws from this moment on that were flown both with this part (or `everything`) and as control,
/// with the same noise.
PairedOutcomes pairs_at(const Explanation& explanation, const std::string& part, double before_end_s);

/// Flies what tells most, and decides. Equal answers give equal questions.
Explanation explain(const ExplanationOptions& options, const FlyRedraws& fly);

/// Shares of the successes that never fall from one entry to the next and fit best (weighted least squares,
/// pool adjacent violators: Ayer et al. 1955, Ann. Math. Stat. 26). An entry without trials takes its
/// neighbour's; without any trials all are 0.
std::vector<double> monotone_fit(std::span<const Share> shares);

}  // namespace understory
