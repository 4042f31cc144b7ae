// The default robot, read once.
#pragma once

#include "sim/robot/robot.h"

namespace stagger::sim {

inline std::shared_ptr<const Robot> kasaei() {
  static const std::shared_ptr<const Robot> robot = load_robot("robots/kasaei");
  return robot;
}

}  // namespace stagger::sim
