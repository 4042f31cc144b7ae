#include "sim/control/senses.h"

#include <gmock/gmock.h>

#include <limits>

namespace stagger::sim {
namespace {

using ::testing::HasSubstr;

std::string error_of(const SenseParameters& parameters) {
  try {
    validate(parameters);
  } catch (const std::invalid_argument& error) {
    return error.what();
  }
  return "";
}

TEST(Senses, DefaultsAndTheEndsOfTheRangesAreValid) {
  SenseParameters p;
  EXPECT_EQ(error_of(p), "");
  p.control_delay = max_control_delay;
  EXPECT_EQ(error_of(p), "");
}

TEST(Senses, AnErrorNamesFieldValueAndRange) {
  SenseParameters p;
  p.control_delay = 0.011;
  EXPECT_THAT(error_of(p), HasSubstr("control_delay = 0.011; allowed: 0 to 0.01 s"));
  p = {};
  p.sensors.imu.delay_ticks = -1;
  EXPECT_THAT(error_of(p), HasSubstr("imu.delay_ticks = -1"));
  p = {};
  p.sensors.encoder.velocity_noise = std::numeric_limits<double>::quiet_NaN();
  EXPECT_THAT(error_of(p), HasSubstr("encoder.velocity_noise = nan"));
  p = {};
  p.sensors.foot.moment_bias = 1.5;
  EXPECT_THAT(error_of(p), HasSubstr("foot.moment_bias = 1.5"));
}

}  // namespace
}  // namespace stagger::sim
