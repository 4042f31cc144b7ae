#include "server/http/problem.h"

#include "server/json/json.h"

namespace stagger::server {
namespace {

std::string summary(std::size_t count) {
  return count == 1 ? "1 field is not as it should be"
                    : std::to_string(count) + " fields are not as they should be";
}

}  // namespace

Problem::Problem(const sim::JsonErrors& list)
    : std::runtime_error(summary(list.list().size())), status(422), errors(list.list()) {}

Problem Problem::with_header(const std::string& name, const std::string& value) const {
  Problem problem = *this;
  problem.headers.emplace_back(name, value);
  return problem;
}

std::string reason_phrase(int status) {
  switch (status) {
    case 400:
      return "Bad request";
    case 401:
      return "Unauthorized";
    case 403:
      return "Forbidden";
    case 404:
      return "Not found";
    case 405:
      return "Method not allowed";
    case 409:
      return "Conflict";
    case 413:
      return "Content too large";
    case 414:
      return "URI too long";
    case 415:
      return "Unsupported media type";
    case 422:
      return "Invalid request";
    case 429:
      return "Too many requests";
    case 426:
      return "Upgrade required";
    case 503:
      return "Service unavailable";
    case 504:
      return "Timeout";
    default:
      return status < 500 ? "Request refused" : "Server error";
  }
}

HttpResponse to_response(const Problem& problem) {
  Json body{{"type", "about:blank"},
            {"title", reason_phrase(problem.status)},
            {"status", problem.status},
            {"detail", problem.what()}};
  if (!problem.errors.empty()) {
    Json errors = Json::array();
    for (const sim::JsonError& error : problem.errors) {
      errors.push_back({{"pointer", error.pointer}, {"detail", error.text}});
    }
    body["errors"] = std::move(errors);
  }
  return {problem.status, "application/problem+json", to_text(body), problem.headers};
}

Problem to_problem(const CommandError& error) {
  const auto with_status = [&error](int status) { return Problem(status, error.what()); };
  switch (error.kind()) {
    case CommandError::Kind::conflict:
      return with_status(409);
    case CommandError::Kind::not_found:
      return with_status(404);
    case CommandError::Kind::invalid:
      return with_status(422);
    case CommandError::Kind::timeout:
      return with_status(504);
    case CommandError::Kind::failed:
      return with_status(500);
    case CommandError::Kind::busy:
    case CommandError::Kind::stopping:
      break;
  }
  return with_status(503).with_header("Retry-After", "1");
}

}  // namespace stagger::server
