#include "server/http/routes/body.h"

#include <charconv>

#include "server/http/message.h"
#include "server/http/problem.h"
#include "sim/json_file.h"

namespace stagger::server {
namespace {

// "application/json; charset=utf-8" is JSON too.
bool is_json(std::string type) {
  type = type.substr(0, type.find(';'));
  while (!type.empty() && type.back() == ' ') type.pop_back();
  return lower(type) == "application/json";
}

nlohmann::json parse_body(const HttpRequest& request, bool may_be_empty) {
  if (!request.form.empty()) throw Problem(415, "the body is a form; send application/json");
  if (request.body.empty()) {
    if (may_be_empty) return nlohmann::json::object();
    throw Problem(400, "the body is empty; send a JSON object");
  }
  const std::string type = request.header("content-type");
  if (!is_json(type)) {
    throw Problem(415, "the body is " + (type.empty() ? "of no stated type" : type) +
                           "; send it as application/json");
  }
  try {
    return sim::parse_json(request.body);
  } catch (const sim::JsonSyntaxError& error) {
    throw Problem(400, "the body is not JSON: line " + std::to_string(error.line) + ", column " +
                           std::to_string(error.column) + ": " + error.what());
  }
}

}  // namespace

void read_body(const HttpRequest& request, bool may_be_empty,
               const sim::JsonReader::Fields& fields) {
  sim::JsonErrors errors;
  sim::read_json(parse_body(request, may_be_empty), errors, fields);
  if (!errors.empty()) throw Problem(errors);
}

nlohmann::json json_body(const HttpRequest& request) { return parse_body(request, false); }

void expect_no_fields(const HttpRequest& request) {
  read_body(request, true, [](sim::JsonReader&) {});
}

std::string source_of(const HttpRequest& request) {
  std::string source = request.header("x-stagger-client").substr(0, 64);
  std::erase_if(source, [](unsigned char c) { return std::isprint(c) == 0; });
  return source.empty() ? "http" : source;
}

std::optional<std::uint64_t> whole_number(const std::string& text) {
  std::uint64_t value = 0;
  const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), value);
  if (error != std::errc() || end != text.data() + text.size()) return std::nullopt;
  return value;
}

HttpResponse json_response(const Json& body, int status) {
  return {status, "application/json", to_text(body), {{"Cache-Control", "no-store"}}};
}

Json effect_json(const Effect& effect) {
  return {{"tick", effect.tick}, {"time_s", effect.time_s}};
}

}  // namespace stagger::server
