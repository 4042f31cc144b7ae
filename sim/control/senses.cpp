#include "sim/control/senses.h"

#include <sstream>
#include <stdexcept>

namespace stagger::sim {
namespace {

void check(const char* field, double value, double most, const char* unit) {
  if (value >= 0.0 && value <= most) return;  // a NaN is not
  std::ostringstream text;
  text << "sense parameters " << field << " = " << value << "; allowed: 0 to " << most << ' '
       << unit;
  throw std::invalid_argument(text.str());
}

}  // namespace

void validate(const SenseParameters& p) {
  check("control_delay", p.control_delay, max_control_delay, "s");
  const ImuParameters& imu = p.sensors.imu;
  check("imu.gyro_noise", imu.gyro_noise, 1.0, "rad/s");
  check("imu.gyro_bias", imu.gyro_bias, 1.0, "rad/s");
  check("imu.accelerometer_noise", imu.accelerometer_noise, 10.0, "m/s^2");
  check("imu.accelerometer_bias", imu.accelerometer_bias, 10.0, "m/s^2");
  check("imu.delay_ticks", imu.delay_ticks, ImuParameters::max_delay_ticks, "ticks");
  const EncoderParameters& encoder = p.sensors.encoder;
  check("encoder.position_noise", encoder.position_noise, 0.1, "rad");
  check("encoder.velocity_noise", encoder.velocity_noise, 10.0, "rad/s");
  const FootForceParameters& foot = p.sensors.foot;
  check("foot.force_noise", foot.force_noise, 1.0, "of the weight");
  check("foot.force_bias", foot.force_bias, 1.0, "of the weight");
  check("foot.moment_noise", foot.moment_noise, 1.0, "of weight times sole length");
  check("foot.moment_bias", foot.moment_bias, 1.0, "of weight times sole length");
}

}  // namespace stagger::sim
