// RFC 9457 problem details: the one form of every error that the API answers.
#pragma once

#include <exception>
#include <stdexcept>
#include <string>
#include <utility>
#include <vector>

#include "server/http/message.h"
#include "server/live/ticket.h"
#include "sim/strict_json.h"

namespace stagger::server {

/// What a route throws to answer with an error.
class Problem : public std::runtime_error {
 public:
  Problem(int http_status, const std::string& detail)
      : std::runtime_error(detail), status(http_status) {}
  /// 422: fields are not as they should be.
  explicit Problem(const sim::JsonErrors& errors);

  /// The same with a header more.
  Problem with_header(const std::string& name, const std::string& value) const;

  int status;
  std::vector<sim::JsonError> errors;
  std::vector<std::pair<std::string, std::string>> headers;
};

/// "Not Found" for 404, ...
std::string reason_phrase(int status);

HttpResponse to_response(const Problem& problem);

/// The problem that a failed command becomes.
Problem to_problem(const CommandError& error);

}  // namespace stagger::server
