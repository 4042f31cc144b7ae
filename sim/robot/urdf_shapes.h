// Collision geometry of a URDF as Shapes.
#pragma once

#include <urdf_model/link.h>

#include <optional>
#include <string>

#include "sim/robot/urdf_import.h"

namespace stagger::sim {

/// Answer to collision geometry that cannot be used.
inline constexpr const char* geometry_left_out = "goes without this collision geometry";

/// Pose of urdfdom as Eigen's.
Eigen::Isometry3d to_isometry(const urdf::Pose& pose);

/// What becomes of one collision element.
struct ShapeResult {
  std::optional<Shape> shape;  ///< pose as in the link's frame
  std::string what;            ///< what is odd about it; empty when nothing is
  std::string answer;          ///< what was done about it
  bool mended = false;         ///< it would not have done as it is: an error when strict
  bool left_out = false;       ///< it could not be mended either
  std::string uri;             ///< of its mesh
  std::filesystem::path mesh;  ///< file of its mesh
};

/// `to_world`: of the link's frame, with all joints at zero. Throws std::runtime_error without the
/// link's name: sizes that are not finite; when strict, anything that is odd as well.
ShapeResult read_shape(const urdf::Collision& collision, const Eigen::Matrix3d& to_world,
                       const ImportOptions& options);

}  // namespace stagger::sim
