// What a campaign varies, in words for people.
#pragma once

#include <string>

#include "server/json/json.h"

namespace stagger::server {

/// "push.direction_deg": "direction (°)"; a path that has no words stays as it is.
std::string path_words(const std::string& path);

/// The value of that field: "90°", "left single support at 0.5", "ankle + hip".
std::string value_words(const std::string& path, const Json& value);

/// All of {"path": value}, with what it is before each: "direction 90°, push 0.2". The name of a
/// list's scenario stands for the pushes that it sets.
std::string values_words(const Json& values);

/// Any JSON in few words: {"vx":0.3,"vy":0} is "vx 0.3, vy 0".
std::string flat_words(const Json& value);

}  // namespace stagger::server
