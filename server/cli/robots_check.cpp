#include <cmath>
#include <iomanip>
#include <iostream>
#include <sstream>

#include "server/cli/cli.h"
#include "server/cli/commands.h"
#include "server/json/json.h"
#include "sim/robot/biped_finder.h"
#include "sim/robot/description_writer.h"

namespace stagger::server {
namespace {

std::string fixed(double value, int digits) {
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
            << "  " << fixed(f.mass, 2) << " kg, CoM at " << fixed(f.com_height, 3) << " m, omega "
            << fixed(f.omega, 2) << " 1/s, legs of " << fixed(f.leg_length, 3) << " m, stance "
            << fixed(f.stance_width, 3) << " m wide\n"
            << "  soles " << fixed(sole.length, 3) << " m x " << fixed(sole.width, 3)
            << " m; the ankle moves the ZMP by +" << fixed(f.ankle_ahead, 3) << "/-"
            << fixed(f.ankle_behind, 3) << " m ahead/behind, " << fixed(f.ankle_inward, 3) << '/'
            << fixed(f.ankle_outward, 3) << " m inward/outward\n";
  for (const sim::Leg& leg : found.legs.leg) {
    std::cout << "  leg to " << leg.foot << ':';
    for (const sim::LegJoint& joint : leg.joints) {
      std::cout << ' ' << joint.name << " (" << sim::name(joint.role) << ')';
    }
    std::cout << '\n';
  }
  for (const sim::HoldingTorque& h : f.holding) {
    std::cout << "  on one leg, " << h.joint << " holds " << fixed(h.needed, 1) << " of "
              << fixed(h.limit, 1) << " N m\n";
  }
  std::cout << "  " << (found.quirks.empty() ? "no quirks" : "quirks:") << '\n';
  for (const sim::Quirk& quirk : found.quirks) {
    std::cout << "    " << quirk.where << ": " << quirk.what << " -> " << quirk.answer << '\n';
  }
}

}  // namespace

int robots_check_command(const RobotsCheckOptions& options) {
  sim::BipedFinding found;
  try {
    found = sim::find_biped(options.urdf);
  } catch (const sim::CannotWalk& refusal) {
    if (options.json) {
      const Json answer = {{"urdf", options.urdf}, {"walks", false}, {"reason", refusal.what()}};
      std::cout << answer.dump(2) << '\n';
    }
    std::cerr << "stagger: " << options.urdf << ": cannot walk: " << refusal.what() << '\n';
    return exit_no;
  }
  if (!options.write.empty()) sim::write_robot(found, options.write);
  if (options.json) {
    std::cout << finding_json(found).dump(2) << '\n';
  } else {
    print(found);
  }
  return exit_ok;
}

}  // namespace stagger::server
