// What goes into the engine: the state of the robot as its sensors and estimator tell it.
#pragma once

#include "engine/types.h"

namespace stagger::engine {

/// One measurement, in the world frame. Whether it is noisy or perfect is the plant's business.
struct Measurement {
  Vec3 com = Vec3::Zero();           ///< centre of mass [m]
  Vec3 com_velocity = Vec3::Zero();  ///< velocity of the centre of mass [m/s]
  Vec2 zmp = Vec2::Zero();      ///< zero moment point on the ground [m]; kept while no foot loads
  PerFoot<FootPose> feet;       ///< pose of each sole
  PerFoot<double> foot_load{};  ///< normal force under each foot [N]
};

}  // namespace stagger::engine
