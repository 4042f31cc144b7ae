// JSON of the server: what is written keeps its order, what is read goes through sim/strict_json.h.
#pragma once

#include <nlohmann/json.hpp>
#include <optional>
#include <string>

namespace stagger::server {

/// Keeps the order in which fields are written, so that answers read as the documentation does.
using Json = nlohmann::ordered_json;

/// Compact text; bytes that are not UTF-8 are replaced, numbers that are not finite become null.
inline std::string to_text(const Json& value) {
  return value.dump(-1, ' ', false, Json::error_handler_t::replace);
}

template <typename T>
Json or_null(const std::optional<T>& value) {
  return value ? Json(*value) : Json(nullptr);
}

}  // namespace stagger::server
