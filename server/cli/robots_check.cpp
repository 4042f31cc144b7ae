#include <sys/prctl.h>
#include <sys/resource.h>
#include <unistd.h>

#include <cmath>
#include <csignal>
#include <filesystem>
#include <iomanip>
#include <iostream>
#include <optional>
#include <sstream>

#include "server/cli/cli.h"
#include "server/cli/commands.h"
#include "server/json/json.h"
#include "sim/robot/biped_finder.h"
#include "sim/robot/description_writer.h"

namespace stagger::server {
namespace {

std::string with_digits(double value, int digits) {
  std::ostringstream text;
  text << std::fixed << std::setprecision(digits) << value;
  return text.str();
}

Json finite(double value) { return std::isfinite(value) ? Json(value) : Json(); }

Json leg_json(const sim::Leg& leg, const sim::BipedFinding& found) {
  Json joints = Json::array();
  for (const sim::LegJoint& joint : leg.joints) {
    const auto i = static_cast<std::size_t>(found.robot.model.joint_index(joint.name)) + 1;
    const sim::Body& body = found.robot.model.bodies[i];
    joints.push_back({{"name", joint.name},
                      {"role", sim::name(joint.role)},
                      {"axis", {joint.axis.x(), joint.axis.y(), joint.axis.z()}},
                      {"lower_rad", finite(body.lower)},
                      {"upper_rad", finite(body.upper)},
                      {"effort_nm", finite(body.effort)},
                      {"velocity_rad_s", finite(body.velocity)}});
  }
  return {{"foot", leg.foot}, {"length_m", leg.length()}, {"joints", std::move(joints)}};
}

Json figures_json(const sim::BipedFigures& f) {
  Json holding = Json::array();
  for (const sim::HoldingTorque& h : f.holding) {
    holding.push_back({{"joint", h.joint}, {"needed_nm", h.needed}, {"limit_nm", finite(h.limit)}});
  }
  return {{"mass_kg", f.mass},
          {"com_height_m", f.com_height},
          {"omega_1_s", f.omega},
          {"leg_length_m", f.leg_length},
          {"leg_share", f.leg_share},
          {"stance_width_m", f.stance_width},
          {"ankle_m",
           {{"ahead", f.ankle_ahead},
            {"behind", f.ankle_behind},
            {"inward", f.ankle_inward},
            {"outward", f.ankle_outward}}},
          {"single_support", std::move(holding)}};
}

Json finding_json(const sim::BipedFinding& found) {
  Json quirks = Json::array();
  for (const sim::Quirk& quirk : found.quirks) {
    quirks.push_back({{"where", quirk.where}, {"what", quirk.what}, {"answer", quirk.answer}});
  }
  return {{"urdf", found.urdf.string()},
          {"walks", true},
          {"robot", found.robot.name},
          {"legs",
           {{"left", leg_json(found.legs.leg[0], found)},
            {"right", leg_json(found.legs.leg[1], found)}}},
          {"figures", figures_json(found.figures)},
          {"quirks", std::move(quirks)},
          {"description", Json::parse(sim::description_json(found.robot.description))}};
}

void print(const sim::BipedFinding& found) {
  const sim::BipedDescription& biped = found.robot.description;
  const sim::BipedFigures& f = found.figures;
  const sim::SoleDescription& sole = biped.feet[0].sole;
  std::cout << found.urdf.string() << ": a biped, \"" << found.robot.name << "\"\n"
            << "  base " << biped.base << ", torso " << biped.torso << ", feet "
            << biped.feet[0].link << " and " << biped.feet[1].link << '\n'
            << "  " << with_digits(f.mass, 2) << " kg, CoM at " << with_digits(f.com_height, 3)
            << " m, omega " << with_digits(f.omega, 2) << " 1/s, legs of "
            << with_digits(f.leg_length, 3) << " m, stance " << with_digits(f.stance_width, 3)
            << " m wide\n"
            << "  soles " << with_digits(sole.length, 3) << " m x " << with_digits(sole.width, 3)
            << " m; the ankle moves the ZMP by +" << with_digits(f.ankle_ahead, 3) << "/-"
            << with_digits(f.ankle_behind, 3) << " m ahead/behind, "
            << with_digits(f.ankle_inward, 3) << '/' << with_digits(f.ankle_outward, 3)
            << " m inward/outward\n";
  for (const sim::Leg& leg : found.legs.leg) {
    std::cout << "  leg to " << leg.foot << ':';
    for (const sim::LegJoint& joint : leg.joints) {
      std::cout << ' ' << joint.name << " (" << sim::name(joint.role) << ')';
    }
    std::cout << '\n';
  }
  for (const sim::HoldingTorque& h : f.holding) {
    std::cout << "  on one leg, " << h.joint << " holds " << with_digits(h.needed, 1) << " of "
              << with_digits(h.limit, 1) << " N m\n";
  }
  std::cout << "  " << (found.quirks.empty() ? "no quirks" : "quirks:") << '\n';
  for (const sim::Quirk& quirk : found.quirks) {
    std::cout << "    " << quirk.where << ": " << quirk.what << " -> " << quirk.answer << '\n';
  }
}

// A mesh of 32 MB as text takes 121 MB of address space and 1.5 s.
constexpr rlim_t untrusted_memory = 2UL << 30U;  // [bytes]
constexpr rlim_t untrusted_time = 20;            // of the processor [s]
constexpr int untrusted_nice = 10;

/// Whatever the files make of this process, it ends soon, and nobody else is out of memory or
/// waits for the processor.
void live_on_little() {
  const auto limit = [](auto what, rlim_t most) {
    const rlimit both{most, most};
    setrlimit(what, &both);
  };
  prctl(PR_SET_PDEATHSIG, SIGKILL);  // whoever asked has gone
  limit(RLIMIT_CORE, 0);
#ifndef STAGGER_SANITIZED
  // Sanitizers reserve terabytes, and are slow.
  limit(RLIMIT_AS, untrusted_memory);
  limit(RLIMIT_CPU, untrusted_time);
#endif
  setpriority(PRIO_PROCESS, 0, untrusted_nice);
}

bool has_description(const std::string& urdf) {
  std::error_code ignored;
  return std::filesystem::exists(std::filesystem::path(urdf).parent_path() / "robot.json", ignored);
}

}  // namespace

int robots_check_command(const RobotsCheckOptions& options) {
  if (options.untrusted) live_on_little();
  std::optional<sim::BipedFinding> found;
  std::string reason;
  try {
    found = sim::find_biped(options.urdf);
  } catch (const sim::CannotWalk& refusal) {
    reason = refusal.what();
  }
  if (found && !options.write.empty()) sim::write_robot(*found, options.write);
  if (options.load && (found || has_description(options.urdf))) {
    const std::filesystem::path folder = std::filesystem::path(options.urdf).parent_path();
    sim::load_robot(folder.empty() ? "." : folder);
  } else if (!found) {
    if (options.json) {
      const Json answer = {{"urdf", options.urdf}, {"walks", false}, {"reason", reason}};
      std::cout << to_text(answer) << '\n';
    }
    std::cerr << "stagger: " << options.urdf << ": cannot walk: " << reason << '\n';
    return exit_no;
  }
  if (options.json) {
    // As the description says, then: what could not be found is told as the reason.
    const Json by_hand = {{"urdf", options.urdf}, {"walks", true}, {"reason", reason}};
    std::cout << (found ? finding_json(*found) : by_hand)
                     .dump(2, ' ', false, Json::error_handler_t::replace)
              << '\n';
  } else if (found) {
    print(*found);
  } else {
    std::cout << options.urdf << ": walks as its robot.json says; by itself it does not: " << reason
              << '\n';
  }
  return exit_ok;
}

}  // namespace stagger::server
