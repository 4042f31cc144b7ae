#include "sim/world_command.h"

namespace stagger::sim {
namespace {

struct Apply {
  Simulation& world;

  void operator()(const Walk& walk) const { world.walk(walk.command); }
  void operator()(const StopWalking& /*none*/) const { world.stop_walking(); }
  void operator()(const SetStrategies& set) const { world.set_strategies(set.strategies); }
  void operator()(const StartPush& push) const { world.push(push.spec); }
  void operator()(const FollowSteps& follow) const { world.follow(follow.steps); }
  void operator()(const SetParameters& set) const { world.set_parameters(set.values); }
  void operator()(const CancelPush& cancel) const { world.cancel_push(cancel.id); }
};

}  // namespace

void apply(Simulation& world, const WorldCommand& command) { std::visit(Apply{world}, command); }

}  // namespace stagger::sim
