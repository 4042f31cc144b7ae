#include "server/campaign/plan.h"

#include <algorithm>
#include <cmath>
#include <span>

#include "server/campaign/hash.h"
#include "server/json/trial_json.h"
#include "sim/state_hash.h"

namespace stagger::server::campaign {
namespace {

using nlohmann::json;

constexpr double gravity = 9.81;  // [m/s^2]
/// One trial in so many is run twice.
constexpr std::uint64_t guard_share = 100;
/// Seeds are what JSON's numbers hold exactly.
constexpr unsigned seed_bits = 53;
/// run_trial() waits so long for the trigger of a push [s].
constexpr double trigger_patience_s = 10.0;

double wave_speed(const sim::Robot& robot) {
  return std::sqrt(gravity * robot.description.walk.com_height_m);
}

/// Sets the value at a path, making objects on its way. A step into an array is an index.
bool put(json& root, const std::string& path, const json& value) {
  json* at = &root;
  for (const std::string& step : path_steps(path)) {
    if (at->is_null()) *at = json::object();
    if (at->is_array()) {
      const bool digits = !step.empty() && step.size() < 10 &&
                          step.find_first_not_of("0123456789") == std::string::npos;
      const std::size_t index = digits ? std::stoul(step) : at->size();
      if (index >= at->size()) return false;
      at = &(*at)[index];
    } else if (at->is_object()) {
      at = &(*at)[step];
    } else {
      return false;
    }
  }
  *at = value;
  return true;
}

/// delta_v of a push of 1 in terms of that name [m/s].
double unit_speed(std::string_view name, const sim::Robot& robot) {
  return name == "fr" ? wave_speed(robot) : 1.0;
}

/// A push may say how hard it is in terms of the robot: delta_v [m/s] or fr.
void scale_push(json& push, const std::string& pointer, const sim::Robot* robot,
                sim::JsonErrors& errors) {
  if (!push.is_object()) return;
  int given = 0;
  for (const char* name : {"impulse_ns", "force_n", "delta_v", "fr"}) {
    if (push.contains(name)) ++given;
  }
  for (const char* name : {"delta_v", "fr"}) {
    const auto found = push.find(name);
    if (found == push.end()) continue;
    const json value = *found;
    push.erase(found);
    const bool in_range = value.is_number() && value.get<double>() > 0.0;
    if (given > 1) {
      errors.add(pointer + "/" + name,
                 "cannot be given together with impulse_ns, force_n, delta_v "
                 "or fr");
    } else if (!in_range) {
      errors.add(pointer + "/" + name, "is no number above 0");
    }
    // Else the robot's name is wrong, which is told elsewhere.
    const bool scaled = robot != nullptr && in_range && given == 1;
    push["impulse_ns"] =
        scaled ? value.get<double>() * unit_speed(name, *robot) * robot->model.mass() : 1.0;
  }
}

std::span<const sim::PushSpec> pushes_of(const sim::TrialSpec& spec) {
  if (spec.push) return {&*spec.push, 1};
  return spec.pushes;
}

PushFigures figures_of(const sim::TrialSpec& spec, const sim::Robot& robot) {
  PushFigures figures;
  for (const sim::PushSpec& push : pushes_of(spec)) {
    if (push.impulse_ns <= figures.impulse_ns) continue;
    figures.impulse_ns = push.impulse_ns;
    figures.force_n = push.impulse_ns / push.duration_s;
  }
  figures.delta_v = figures.impulse_ns / robot.model.mass();
  figures.fr = figures.delta_v / wave_speed(robot);
  return figures;
}

/// Simulated time that the trial can need at the most [s].
double longest(const sim::TrialSpec& spec) {
  double time = spec.settle_s + spec.observe_s;
  double latest = 0.0;
  for (const sim::PushSpec& push : pushes_of(spec)) {
    time += push.duration_s;
    if (std::holds_alternative<sim::Immediate>(push.trigger)) continue;
    time += trigger_patience_s;
    if (const auto* at = std::get_if<sim::TimeTrigger>(&push.trigger)) {
      latest = std::max(latest, at->at_s);
    }
  }
  return time + latest;
}

}  // namespace

std::optional<double> push_figure(std::string_view path, const PushFigures& figures) {
  if (path == "push.impulse_ns") return figures.impulse_ns;
  if (path == "push.delta_v") return figures.delta_v;
  if (path == "push.fr") return figures.fr;
  return std::nullopt;
}

Plan::Plan(CampaignSpec spec, RobotLibrary& library) : spec_(std::move(spec)), design_(spec_) {
  for (const std::string& name : library.names()) {
    known_robots_ += (known_robots_.empty() ? "" : ", ") + name;
  }
  if (spec_.base.is_object() && spec_.base.contains("robot")) {
    take_robot(spec_.base["robot"], library);
  }
  for (const Factor& factor : spec_.factors) {
    if (factor.path != "robot") continue;
    for (const json& value : factor.values) take_robot(value, library);
  }
  for (const Entry& entry : spec_.design.entries) {
    for (const auto& [path, value] : entry.settings) {
      if (path == "robot") take_robot(value, library);
    }
  }
}

void Plan::take_robot(const json& name, RobotLibrary& library) {
  if (!name.is_string() || robots_.contains(name.get<std::string>())) return;
  if (auto robot = library.find(name.get<std::string>())) {
    robots_.emplace(name.get<std::string>(), std::move(robot));
  }
}

std::shared_ptr<const sim::Robot> Plan::robot(const std::string& name) const {
  const auto found = robots_.find(name);
  return found == robots_.end() ? nullptr : found->second;
}

json Plan::assembled(const std::vector<Setting>& settings, std::uint64_t number,
                     sim::JsonErrors& errors) const {
  json trial = spec_.base;
  if (!trial.is_object()) trial = json::object();
  trial["seed"] = mixed(mixed(spec_.seed), number) >> (64U - seed_bits);
  for (const auto& [path, value] : settings) {
    if (path == "name") continue;
    if (!put(trial, path, value)) {
      errors.add(path_pointer(path), "leads through a field that has no such part");
    }
  }
  const auto name = trial.find("robot");
  const auto robot =
      name != trial.end() && name->is_string() ? this->robot(name->get<std::string>()) : nullptr;
  if (trial.contains("push")) scale_push(trial["push"], "/push", robot.get(), errors);
  if (const auto pushes = trial.find("pushes"); pushes != trial.end() && pushes->is_array()) {
    for (std::size_t i = 0; i < pushes->size(); ++i) {
      scale_push((*pushes)[i], "/pushes/" + std::to_string(i), robot.get(), errors);
    }
  }
  return trial;
}

sim::TrialSpec Plan::read(const json& assembled, sim::JsonErrors& errors) const {
  sim::TrialSpec spec = read_trial(assembled, errors);
  if (spec.robot.empty()) return spec;  // said already
  const auto robot = this->robot(spec.robot);
  if (robot == nullptr) {
    errors.add("/robot", "is \"" + spec.robot + "\"; robots here: " +
                             (known_robots_.empty() ? "none" : known_robots_));
  } else {
    check_for_robot(spec, robot, errors);
  }
  if (errors.empty() && longest(spec) > spec_.trial_timeout_s) {
    errors.add("", "a trial can take " + json(longest(spec)).dump() +
                       " s of simulated time; allowed by trial_timeout_s: " +
                       json(spec_.trial_timeout_s).dump());
  }
  return spec;
}

PlannedTrial Plan::trial(std::uint64_t number) const {
  PlannedTrial trial;
  trial.number = number;
  const Place place = design_.place(number);
  trial.repeat = place.repeat;
  const std::vector<Setting> settings = design_.settings(place);
  trial.values = Json::object();
  for (const auto& [path, value] : settings) trial.values[path] = value;
  // Every design runs its trial 0.
  trial.twice = number == 0 || mixed(mixed(spec_.seed, 1), number) % guard_share == 0;

  sim::JsonErrors errors;
  const json body = assembled(settings, number, errors);
  trial.spec = read(body, errors);
  std::string text;
  if (errors.empty()) {
    trial.robot = robot(trial.spec.robot);
    trial.push = figures_of(trial.spec, *trial.robot);
    trial.resolved = trial_spec_json(trial.spec);
    text = to_text(trial.resolved);
  } else {
    trial.refused = errors.list().front().pointer + " " + errors.list().front().text;
    trial.twice = false;
    text = body.dump(-1, ' ', false, json::error_handler_t::replace);
  }
  trial.id = sim::to_hex(hash_text(text, hash_text(STAGGER_VERSION)));
  return trial;
}

}  // namespace stagger::server::campaign
