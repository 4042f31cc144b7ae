// Robots as JSON, and the question whether a robot has a link.
#pragma once

#include <optional>
#include <string>

#include "server/json/json.h"
#include "sim/robot/robot.h"

namespace stagger::server {

/// {"name","mass_kg","com_height_m","walking_com_height_m","base_link","torso_link",
/// "sole":{...},"links":[...],"joints":[...]}; heights of the CoM in the nominal pose and while
/// walking; the base link is the one that the channel base_position tells of.
Json robot_json(const sim::Robot& robot);

/// Nothing when the robot has that link or none is named; else what to tell whoever asked for it.
std::optional<std::string> check_link(const std::string& link, const sim::Robot& robot);

}  // namespace stagger::server
