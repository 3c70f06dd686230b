#include "estimation/filter_config.hpp"

#include <cmath>

namespace understory {

FilterConfig windy_filter() {
  FilterConfig config;
  config.states.wind = config.states.gust = true;
  config.sideslip.model_error = 0.05;
  config.angle_of_attack.enabled = true;  // nothing else shows a vertical gust, which is no state
  return config;
}

FilterConfig original_filter() {
  constexpr double degree = M_PI / 180;
  FilterConfig config;
  config.model = FilterModel::angular_rate;
  config.states.accelerometer_bias = config.states.pitot_bias = false;
  config.rest.launch_speed_sigma_mps = 0.2;
  config.start.tilt_sigma_rad = config.start.yaw_sigma_rad = 3 * degree;
  config.start.velocity_sigma_mps = 0.15;
  config.start.horizontal_sigma_m = 0.5;
  config.start.vertical_sigma_m = 1.0;
  config.gyro_noise_radps_rthz = 0.5 * degree;
  config.accelerometer_noise_mps2_rthz = 0.2;
  config.smooth_frame = false;
  config.distrust.exclude = false;  // it had no gates to speak of
  config.airspeed.sigma_mps = std::sqrt(15.0);
  config.sideslip.model = SideslipModel::zero;
  config.sideslip.zero_sigma_mps = std::sqrt(5.0);
  config.altitude.sigma_m = std::sqrt(5.0);
  config.angle_of_attack.enabled = false;
  config.heading.enabled = false;
  return config;
}

}  // namespace understory
