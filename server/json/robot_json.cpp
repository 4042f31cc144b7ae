#include "server/json/robot_json.h"

#include "sim/robot/posture.h"

namespace stagger::server {

Json robot_json(const sim::Robot& robot) {
  Json links = Json::array();
  for (const auto& [name, place] : robot.model.links) links.push_back(name);
  const sim::SoleDescription& sole = robot.description.feet[0].sole;
  return {{"name", robot.name},
          {"mass_kg", robot.model.mass()},
          {"com_height_m", sim::nominal_com_height(robot)},
          {"walking_com_height_m", robot.description.walk.com_height_m},
          {"base_link", robot.model.bodies.front().name},
          {"torso_link", robot.description.torso},
          {"sole", {{"length_m", sole.length}, {"width_m", sole.width}}},
          {"links", std::move(links)},
          {"joints", robot.model.joint_names()}};
}

std::optional<std::string> check_link(const std::string& link, const sim::Robot& robot) {
  if (link.empty() || robot.model.links.contains(link)) return std::nullopt;
  std::string text = "is \"" + link + "\"; links of " + robot.name + ":";
  for (const auto& [name, place] : robot.model.links) text += " " + name;
  return text;
}

}  // namespace stagger::server
