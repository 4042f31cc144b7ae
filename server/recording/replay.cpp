#include "server/recording/replay.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <stdexcept>

#include "server/json/stream_json.h"
#include "server/recording/recording_reader.h"
#include "server/recording/robot_files.h"
#include "sim/simulation.h"
#include "sim/world_command.h"

namespace stagger::server {
namespace {

/// Where in the world's channel the number is that the recording has at `at` of its own: a part of
/// a recording need not hold all components.
std::optional<std::size_t> place_in(const sim::Channel& world, const sim::Channel& recorded,
                                    std::size_t at) {
  const std::size_t width = recorded.components.size();
  const std::string& name = recorded.components[at % width].name;
  const auto found =
      std::find_if(world.components.begin(), world.components.end(),
                   [&name](const sim::Component& component) { return component.name == name; });
  if (found == world.components.end()) return std::nullopt;
  return at / width * world.components.size() + (found - world.components.begin());
}

std::string label(const sim::Channel& channel, std::size_t at) {
  const std::size_t width = channel.components.size();
  const std::string name =
      channel.max_repeat > 1 ? channel.name + "[" + std::to_string(at / width) + "]" : channel.name;
  const std::string& component = channel.components[at % width].name;
  return width == 1 && component == "value" ? name : name + "." + component;
}

/// How far apart two numbers are; infinite when only one of them is a number.
double distance(double a, double b) {
  if (a == b || (std::isnan(a) && std::isnan(b))) return 0.0;
  const double apart = std::abs(a - b);
  return std::isfinite(apart) ? apart : std::numeric_limits<double>::infinity();
}

class Replayer {
 public:
  Replayer(const RecordedWorld& recorded, const RobotFinder& find_robot) {
    WorldSpec spec = world_of(recorded);
    result_.number = recorded.number;
    result_.session_id = recorded.session_id;
    result_.robot = spec.robot;
    result_.version = recorded.version;
    if (!recorded.journal_is_whole) {
      throw std::runtime_error("the recording's journal does not reach back to the world's start");
    }
    spec.config.robot = find_robot(spec.robot);
    if (spec.config.robot == nullptr) {
      throw std::runtime_error("there is no robot \"" + spec.robot + "\" here");
    }
    if (recorded.version != STAGGER_VERSION) {
      result_.warnings.push_back("recorded by version " + recorded.version + ", replayed by " +
                                 STAGGER_VERSION);
    }
    if (robot_files_hash(spec.config.robot->folder) != recorded.robot_files) {
      result_.warnings.push_back("the files of robot " + spec.robot +
                                 " are not those of the recording");
    }
    world_ = std::make_unique<sim::Simulation>(spec.config);
  }

  void add(sim::JournalEntry entry) {
    if (entry.tick < world_->next_tick()) {
      throw std::runtime_error("a command comes after its tick");
    }
    journal_.push_back(std::move(entry));
  }

  void compare(const RecordedTick& recorded) {
    const RecordedFrame& frame = recorded.frame;
    if (frame.tick < world_->next_tick()) throw std::runtime_error("ticks go back");
    while (world_->next_tick() <= frame.tick) run_tick();
    ++result_.ticks;
    result_.fell = world_->frame().fallen;
    if (!result_.difference) {
      if (world_->state_hash() == frame.state_hash) return;
      result_.difference = {frame.tick, frame.state_hash, world_->state_hash(), {}};
    }
    if (!result_.difference->largest) result_.difference->largest = largest(recorded);
  }

  void warn(const std::string& text) { result_.warnings.push_back(text); }

  /// No more needs to be compared.
  bool done() const { return result_.difference && result_.difference->largest; }
  WorldReplay take() {
    result_.commands = applied_;
    return std::move(result_);
  }

 private:
  void run_tick() {
    for (; applied_ < journal_.size() && journal_[applied_].tick == world_->next_tick();
         ++applied_) {
      sim::apply(*world_, journal_[applied_].command);
    }
    world_->step();
    world_->take_events();
  }

  std::optional<ReplayDifference::Largest> largest(const RecordedTick& recorded) const {
    std::optional<ReplayDifference::Largest> worst;
    double worst_distance = 0.0;
    const auto& channels = recorded.schema->channels();
    std::vector<double> replayed;
    for (std::size_t i = 0; i < channels.size(); ++i) {
      const sim::Channel* channel = sim::find_channel(world_->channels(), channels[i].name);
      if (channel == nullptr) continue;
      replayed.clear();
      channel->read(world_->frame(), replayed);
      const std::vector<double>& values = recorded.frame.values[i];
      for (std::size_t at = 0; at < values.size(); ++at) {
        const auto place = place_in(*channel, channels[i], at);
        if (!place || *place >= replayed.size()) continue;
        const double apart = distance(values[at], replayed[*place]);
        if (apart <= worst_distance) continue;
        worst_distance = apart;
        worst = {recorded.frame.tick, label(channels[i], at),
                 channels[i].components[at % channels[i].components.size()].unit, values[at],
                 replayed[*place]};
      }
    }
    return worst;
  }

  WorldReplay result_;
  std::unique_ptr<sim::Simulation> world_;
  std::vector<sim::JournalEntry> journal_;
  std::size_t applied_ = 0;
};

}  // namespace

std::vector<WorldReplay> replay(const std::filesystem::path& file, const RobotFinder& find_robot) {
  RecordingReader reader(file);
  std::vector<WorldReplay> worlds;
  std::optional<Replayer> present;
  const auto end_world = [&] {
    if (present) worlds.push_back(present->take());
    present.reset();
    return worlds.empty() || !worlds.back().difference;
  };
  while (const auto item = reader.next()) {
    if (const auto* world = std::get_if<RecordedWorld>(&*item)) {
      if (!end_world()) return worlds;
      present.emplace(*world, find_robot);
    } else if (!present) {
      continue;
    } else if (const auto* tick = std::get_if<RecordedTick>(&*item)) {
      present->compare(*tick);
      if (present->done()) break;
    } else if (const auto& text = std::get<RecordedText>(*item); text.is_command) {
      present->add(entry_of(text));
    } else if (cuts_journal(text)) {
      present->warn("not all commands are kept: what comes after them has not been compared");
      break;
    }
  }
  end_world();
  const bool compared = std::any_of(worlds.begin(), worlds.end(),
                                    [](const WorldReplay& world) { return world.ticks > 0; });
  if (!compared) throw std::runtime_error(file.string() + " holds no tick to compare");
  return worlds;
}

}  // namespace stagger::server
