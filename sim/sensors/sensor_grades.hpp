#pragma once

#include "sim/sensors/sensors.hpp"

namespace understory {

/// Quality of a scenario's sensors (`sensors.grade`); keys given beside it win. docs/sensors.md gives each
/// number and its source. GPS is off in every grade.
enum class SensorGrade {
  ideal,     ///< no errors at all; ranges, rates and delays stay
  plain,     ///< white noise and constants only: the defaults of the structs
  consumer,  ///< every error of a part of this class, from data sheets and published measurements
  rough,     ///< every error three times the consumer grade's
};

SensorsConfig sensors_of_grade(SensorGrade grade);

}  // namespace understory
