#include "sim/experiment/paper/closed_loop.h"

#include <algorithm>

namespace stagger::sim {

engine::Parameters paper_parameters(double noise) {
  engine::Parameters p;
  // Perfect measurements get a trace of noise all the same: the filter needs some to be defined.
  p.measurement_noise = std::max(noise * noise, 1e-10);
  // The least at which the paper's noise moves no step by itself (20 seeds, each timing).
  p.step_margin = noise == 0.0 ? 0.01 : 0.03;
  p.step_freeze = noise == 0.0 ? 0.004 : 0.02;
  return p;
}

LipmParameters paper_plant(double noise, std::uint64_t seed, const ModelError& error) {
  LipmParameters truth;
  truth.mass *= error.mass;
  truth.com_height *= error.com_height;
  truth.delay = error.delay;
  truth.noise = noise;
  truth.seed = seed;
  truth.reach = 3.0;  // fallen by divergence, as the paper has it, not by a touch of the edge
  return truth;
}

const engine::WalkingTargets& ClosedLoop::tick(
    const std::function<engine::Vec2(const engine::WalkingTargets&)>& force) {
  const engine::WalkingTargets& t = engine_.update(plant_.measurement());
  sample_.time = time();
  sample_.zmp.reference = t.zmp_reference;
  sample_.com.reference = t.com_reference;
  sample_.dcm.reference = t.dcm_reference;
  const engine::ConvexPolygon& sole = engine_.support_polygon();
  sample_.sole_low = sample_.sole_high = sole.vertex(0);
  for (std::size_t i = 1; i < sole.size(); ++i) {
    sample_.sole_low = sample_.sole_low.cwiseMin(sole.vertex(i));
    sample_.sole_high = sample_.sole_high.cwiseMax(sole.vertex(i));
  }
  sample_.com.actual = plant_.truth().com.head<2>();
  sample_.dcm.actual = plant_.dcm();
  const Vec2 acting = force(t);
  const AppliedForce push{"", Vec3::Zero(), Vec3(acting.x(), acting.y(), 0.0)};
  plant_.step(t, {&push, 1});
  sample_.zmp.actual = plant_.truth().zmp;
  ++ticks_;
  return t;
}

}  // namespace stagger::sim
