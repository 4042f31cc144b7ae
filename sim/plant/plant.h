// The seam behind which every robot stands: targets and forces in, a measurement out.
#pragma once

#include <cstdint>
#include <memory>
#include <span>
#include <string>

#include "engine/measurement.h"
#include "engine/walking_targets.h"
#include "sim/frame.h"
#include "sim/plant/push.h"
#include "sim/state_hash.h"

namespace stagger::sim {

struct WholeBodyGains;

/// The full-body biped in Bullet, or the paper's linear inverted pendulum.
enum class PlantKind : std::uint8_t { bullet, lipm };

class Plant {
 public:
  Plant() = default;
  Plant(const Plant&) = delete;
  Plant& operator=(const Plant&) = delete;
  virtual ~Plant() = default;

  /// What the engine may know now.
  virtual const engine::Measurement& measurement() const = 0;
  /// Advances by one tick under the targets and the pushes.
  virtual void step(const engine::WalkingTargets& targets,
                    std::span<const AppliedForce> forces) = 0;
  /// Other gains from the next tick on; without effect on a plant that has none.
  virtual void set_gains(const WholeBodyGains& /*gains*/) {}
  /// The robot has fallen: no control any more, it goes limp or stays where it is.
  virtual void release() = 0;
  /// Writes the plant's own part of the frame: base, joints, feet, loads, true CoM and ZMP.
  virtual void describe(Frame& frame) const = 0;
  /// Where a force acts, world frame [m].
  virtual Vec3 point_of(const AppliedForce& force) const = 0;
  /// Empty while the robot is up; else why it counts as fallen.
  virtual std::string fall_reason() const = 0;
  /// Mixes every bit of the plant's state into the hash.
  virtual void mix_state(StateHash& hash) const = 0;
};

}  // namespace stagger::sim
