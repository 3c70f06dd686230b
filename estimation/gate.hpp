#pragma once

#include <cstdint>
#include <limits>

namespace understory {

/// The quantile of the chi-square distribution with `degrees` (1, 2 or 3) degrees of freedom at `probability`
/// (in (0, 1)).
double chi_square_quantile(double probability, int degrees);

/// What happens to a sensor that has disagreed for longer than the patience.
enum class Distrust {
  believe,  ///< it is right: its measurements are used until they agree again, so that a wrong estimate can
            ///< be corrected
  exclude,  ///< it is faulty: ignored until it has agreed for as long; the covariance grows meanwhile
};

/// Rejects outliers of one sensor and detects when it has become faulty.
class Gate {
 public:
  Gate(double threshold, double patience_s, Distrust distrust);
  /// Whether to use a measurement at t_ns whose squared normalized innovation is `squared`.
  bool admits(double squared, std::int64_t t_ns);
  /// Whether the sensor has disagreed for longer than the patience and has not agreed as long since.
  bool faulty() const { return faulty_; }
  /// The newest squared normalized innovation; nan before the first.
  double newest() const { return newest_; }

 private:
  double threshold_;
  std::int64_t patience_ns_;
  Distrust distrust_;
  std::int64_t last_ns_ = -1;
  std::int64_t since_ns_ = 0;  ///< start of the present agreement or disagreement
  bool agrees_ = true;
  bool faulty_ = false;
  double newest_ = std::numeric_limits<double>::quiet_NaN();
};

}  // namespace understory
