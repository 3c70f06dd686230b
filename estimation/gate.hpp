#pragma once

#include <cstdint>
#include <optional>

namespace understory {

/// The x below which a chi-square variable of `degrees` (1, 2 or 3) degrees of freedom falls with
/// `probability` (in (0, 1)).
double chi_square_quantile(double probability, int degrees);

/// Keeps outliers of one sensor out. A sensor that disagrees for longer than `patience` is no outlier: then
/// it is let in until it agrees again, so that a wrong estimate can be put right (and a biased sensor is
/// believed).
class Gate {
 public:
  Gate(double threshold, double patience_s);
  /// Whether to use a measurement at t_ns whose squared normalized innovation is `squared`.
  bool admits(double squared, std::int64_t t_ns);

 private:
  double threshold_;
  std::int64_t patience_ns_;
  std::optional<std::int64_t> first_refusal_ns_;
};

}  // namespace understory
