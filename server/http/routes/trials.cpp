#include <memory>
#include <mutex>

#include "server/http/problem.h"
#include "server/http/routes/body.h"
#include "server/http/routes/routes.h"
#include "server/json/trial_json.h"

namespace stagger::server {
namespace {

/// Longer trials, and more pushes, are for `stagger trial` and campaigns [s].
constexpr double longest_trial_s = 30.0;
constexpr std::size_t most_trial_pushes = 10;

void refuse_what_takes_long(const sim::TrialSpec& spec, sim::JsonErrors& errors) {
  const auto check = [&errors](const std::string& field, double value) {
    if (value <= longest_trial_s) return;
    errors.add(field, "is " + to_text(value) + "; allowed here: at most " +
                          to_text(longest_trial_s) + " s");
  };
  const auto check_push = [&check](const std::string& field, const sim::PushSpec& push) {
    const auto* at = std::get_if<sim::TimeTrigger>(&push.trigger);
    if (at != nullptr) check(field + "/at_s", at->at_s);
  };
  check("/settle_s", spec.settle_s);
  check("/observe_s", spec.observe_s);
  if (spec.push) check_push("/push", *spec.push);
  for (std::size_t i = 0; i < spec.pushes.size(); ++i) {
    check_push("/pushes/" + std::to_string(i), spec.pushes[i]);
  }
  if (spec.pushes.size() > most_trial_pushes) {
    errors.add("/pushes", "has " + std::to_string(spec.pushes.size()) +
                              " items; allowed here: at most " + std::to_string(most_trial_pushes));
  }
}

HttpResponse run(const HttpRequest& request, Services& services, std::mutex& one_at_a_time) {
  sim::JsonErrors errors;
  const sim::TrialSpec spec = read_trial(json_body(request), errors);
  std::shared_ptr<const sim::Robot> robot;
  if (!spec.robot.empty()) {
    robot = services.robots.find(spec.robot);
    if (robot == nullptr) {
      errors.add("/robot", services.robots.unknown(spec.robot));
    } else {
      check_for_robot(spec, robot, errors);
    }
  }
  refuse_what_takes_long(spec, errors);
  if (!errors.empty()) throw Problem(errors);
  // More at a time would take the processor from the world that people watch.
  const std::unique_lock lock(one_at_a_time, std::try_to_lock);
  if (!lock.owns_lock()) {
    throw Problem(503, "another trial is under way").with_header("Retry-After", "1");
  }
  return json_response(trial_result_json(sim::run_trial(spec, robot), spec));
}

}  // namespace

void add_trial_routes(Router& router, Services& services) {
  const auto one_at_a_time = std::make_shared<std::mutex>();
  router.add("POST", "/api/v1/trials", [&services, one_at_a_time](const HttpRequest& request) {
    return run(request, services, *one_at_a_time);
  });
}

}  // namespace stagger::server
