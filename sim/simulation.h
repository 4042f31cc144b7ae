// Plant + engine + pushes, one Frame a tick. Deterministic: the same configuration and the same
// calls at the same ticks give the same frames to the bit.
#pragma once

#include <memory>
#include <optional>
#include <span>
#include <stdexcept>
#include <string>
#include <utility>
#include <vector>

#include "engine/parameters.h"
#include "engine/walking_engine.h"
#include "sim/channels.h"
#include "sim/control/senses.h"
#include "sim/frame.h"
#include "sim/plant/bullet_world.h"
#include "sim/plant/plant.h"
#include "sim/plant/push.h"
#include "sim/plant/terrain.h"
#include "sim/robot/robot.h"
#include "sim/state_hash.h"
#include "sim/world_parameters.h"

namespace stagger::sim {

struct SimulationConfig {
  std::shared_ptr<const Robot> robot;  ///< required
  PlantKind plant = PlantKind::bullet;
  std::uint64_t seed = 1;
  engine::Strategies strategies;
  SenseParameters senses;      ///< of the full body; the pendulum has none of them
  TerrainParameters terrain;   ///< the LIPM knows flat ground alone, whatever it is made of
  PhysicsParameters physics;   ///< of the full body; its dt is the tick
  ParameterValues parameters;  ///< what is to differ from all that (parameter_table.h)
};

enum class EventKind : std::uint8_t {
  step,
  adjustment,  ///< of a step: it landed elsewhere or at another time than planned
  push_started,
  push_done,
  push_cancelled,
  strategies,  ///< others may act from now on
  parameters,  ///< a change has taken effect
  fall
};

/// A step is told of as adjusted when the engine moved it by more than this [m] or made it come
/// this much sooner or later [s]. kasaei, undisturbed, stays below.
inline constexpr double told_adjustment_m = 0.02;
inline constexpr double told_adjustment_s = 0.02;

/// Something that happened at one tick. Values are named numbers, the text is for people.
struct Event {
  std::uint64_t tick = 0;
  double time = 0.0;
  EventKind kind = EventKind::step;
  std::string text;
  std::vector<std::pair<std::string, double>> values;
};

/// A list of steps that cannot be walked.
class StepListRefused : public std::invalid_argument {
 public:
  StepListRefused(const std::string& why, std::optional<std::size_t> at)
      : std::invalid_argument(why), step(at) {}
  std::optional<std::size_t> step;  ///< the first that cannot be; none: it is not standing
};

class Simulation {
 public:
  /// Physics and control period [s].
  static constexpr double tick_s = 0.001;

  /// Throws std::invalid_argument when the configuration is not valid: see validate() of the
  /// terrain and check_parameters().
  explicit Simulation(SimulationConfig config);

  /// Runs one tick and returns its frame: the state at the tick's beginning, the targets made from
  /// it and the pushes that act from then on. A fallen robot goes limp; time goes on.
  const Frame& step();
  const Frame& frame() const { return frame_; }
  /// The tick that the next step() runs: commands given now take effect there.
  std::uint64_t next_tick() const { return tick_; }

  /// Start walking (zero velocity: step in place) or change the command. Takes effect next tick.
  void walk(const engine::WalkCommand& command);
  /// Finish the step that is under way and stand.
  void stop_walking();
  void set_strategies(const engine::Strategies& strategies);
  /// Takes these steps, in the true world, and stands; from standing only. All or none: throws
  /// StepListRefused.
  void follow(std::span<const Footstep> steps);
  /// Other parameters: of `values` those that a living world can change, in place of all such
  /// values so far; the others are not looked at. They take effect as the table says. Throws
  /// std::invalid_argument, and nothing has changed, when they are not valid.
  void set_parameters(const ParameterValues& values);
  /// The values that are in effect. config().parameters are those asked for.
  const ParameterValues& active_parameters() const { return active_; }

  /// Adds a push (validated against the robot's links: throws std::invalid_argument for an unknown
  /// link) and returns its id.
  std::uint64_t push(PushSpec spec);
  bool cancel_push(std::uint64_t id);
  const std::vector<PushRecord>& pushes() const { return pushes_.records(); }

  /// Events since the last call.
  std::vector<Event> take_events() { return std::exchange(events_, {}); }

  /// Greatest distance of the measured DCM from its reference so far, while not fallen [m].
  double worst_dcm_error() const { return worst_dcm_error_; }
  /// Hash over the plant's state of every tick so far.
  std::uint64_t state_hash() const { return hash_.value(); }
  /// Empty while the robot is up.
  const std::string& fall_reason() const { return fall_reason_; }

  const SimulationConfig& config() const { return config_; }
  const std::vector<Channel>& channels() const { return channels_; }

 private:
  void note_landing(const engine::WalkingTargets& targets);
  void note_adjustment(const engine::WalkingTargets& targets, const Vec2& landed);
  void note_parameters();
  void note_pushes();
  void note_fall();
  void fill_frame(const engine::WalkingTargets& targets);
  void fill_regions();
  void emit(EventKind kind, std::string text,
            std::vector<std::pair<std::string, double>> values = {});
  /// Between two ticks: as of the next one.
  void emit_now(EventKind kind, std::string text,
                std::vector<std::pair<std::string, double>> values);

  SimulationConfig config_;
  WorldParameters parameters_;  ///< those asked for
  ParameterValues active_;
  bool changing_ = false;  ///< the two differ
  std::vector<Channel> channels_;
  std::unique_ptr<Plant> plant_;
  engine::WalkingEngine engine_;
  PushSchedule pushes_;
  std::vector<std::pair<std::size_t, PushState>> open_pushes_;  ///< as last told in an event
  std::uint64_t tick_ = 0;                                      ///< of the next step()
  Frame frame_;
  std::vector<Event> events_;
  StateHash hash_;
  std::string fall_reason_;
  double worst_dcm_error_ = 0.0;
};

}  // namespace stagger::sim
