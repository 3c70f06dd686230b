#pragma once

#include "sim/sensors/sensors.hpp"

namespace understory {

/// How good a scenario's sensors are (`sensors.grade`); keys given beside it win. What each number is and
/// where it comes from: docs/sensors.md. GPS stays off in every grade.
enum class SensorGrade {
  ideal,     ///< no errors at all; ranges, rates and delays stay
  plain,     ///< white noise and constants only: the defaults of the structs
  consumer,  ///< everything a part of this class does, from data sheets and published measurements
  rough,     ///< every error three times the consumer grade's
};

SensorsConfig sensors_of_grade(SensorGrade grade);

}  // namespace understory
