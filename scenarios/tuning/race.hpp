#pragma once

#include <functional>
#include <optional>
#include <vector>

#include "scenarios/tuning/tuning.hpp"

namespace understory {

/// Drops trials that a glance at the data shows to be worse, so that a search measures few of them whole.
///
/// A trial is compared with rivals on the same part of the data, unit by unit (flights, recordings): the best
/// of those that were measured whole, or the Pareto front of several goals. Its figures on all data are
/// expected to be the rival's and the difference at the glance, and the search's own costs of them decide: it
/// is dropped where none is lower than the rival's and one is higher by more than 1.645 standard errors.
/// These are the jackknife's, since a figure is a share of all counts, not a mean of units (Efron & Stein
/// 1981, Annals of Statistics 9, 586). That is the idea of Hoeffding and F-races (Maron & Moore 1993;
/// Birattari et al. 2002). Successive halving would need a whole generation side by side and would drop half
/// of it, however alike; here a trial that is as good as its rivals is never dropped for want of room.
class Race {
 public:
  /// Gives the units of a glance at a trial; a trial may be asked for again and again.
  using GlanceAt = std::function<const std::vector<Counts>&(const Trial&)>;

  /// Objective and judge outlive the race.
  Race(const Objective& objective, const Judge& judge, GlanceAt glance_at)
      : objective_(objective), judge_(judge), glance_at_(std::move(glance_at)) {}

  /// The figures that a trial would probably have, if it is dropped; nothing if it is to be measured whole. A
  /// glance's own figures would mislead the search: they are those of a small part of the data. So they are
  /// the rival's on all data and the difference at the glance, which the data hardly affect.
  std::optional<Figures> dropped(const std::vector<Counts>& glance) const;
  /// A trial that was measured whole.
  void add(const Trial& trial);

 private:
  /// Of a trial on all data: the rival's, and the difference at the glance.
  Figures expected(const Trial& rival, const std::vector<Counts>& rivals_glance,
                   const std::vector<Counts>& glance) const;

  const Objective& objective_;
  const Judge& judge_;
  GlanceAt glance_at_;
  std::vector<Trial> rivals_;
  bool keep_limits_ = false;  ///< whether the rivals do; otherwise there is one, which misses them least
};

}  // namespace understory
