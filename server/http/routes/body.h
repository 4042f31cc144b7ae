// What the routes share: strict bodies in, JSON out.
#pragma once

#include <cstdint>
#include <optional>
#include <string>

#include "server/http/message.h"
#include "server/json/json.h"
#include "server/live/live_session.h"
#include "sim/strict_json.h"

namespace stagger::server {

/// Reads the body's fields. Throws Problem: 415 when it is not JSON by name, 400 when it is not
/// JSON by content, 422 when a field is missing, unknown or out of range. `may_be_empty`: no body
/// at all counts as {}.
void read_body(const HttpRequest& request, bool may_be_empty,
               const sim::JsonReader::Fields& fields);

/// The same without a look at the fields.
nlohmann::json json_body(const HttpRequest& request);

/// For commands without fields: nothing or {}.
void expect_no_fields(const HttpRequest& request);

/// Who sends the command, for the stream's events: the header X-Stagger-Client, else "http".
std::string source_of(const HttpRequest& request);

/// A text that is a whole number and nothing else.
std::optional<std::uint64_t> whole_number(const std::string& text);

HttpResponse json_response(const Json& body, int status = 200);

Json effect_json(const Effect& effect);

}  // namespace stagger::server
