// Requests and answers as the routes see them: nothing of the HTTP library shows here.
#pragma once

#include <cctype>
#include <cstddef>
#include <filesystem>
#include <functional>
#include <map>
#include <string>
#include <utility>
#include <vector>

namespace stagger::server {

/// ASCII letters in lower case.
inline std::string lower(std::string text) {
  for (char& c : text) c = static_cast<char>(std::tolower(static_cast<unsigned char>(c)));
  return text;
}

/// One part of a form (multipart/form-data).
struct FormPart {
  std::string name;
  std::string filename;  ///< empty for a part that is no file
  std::string content;
};

/// What an answer has cost, for who counts them.
struct RequestSummary {
  std::string method;
  std::string route;  ///< as it was registered; empty when there is none for the path
  int status = 0;
  double seconds = 0.0;  ///< from the arrival of the request to its answer, body included
};

struct HttpRequest {
  std::string method;
  std::string path;  ///< decoded, without the query
  std::multimap<std::string, std::string> query;
  std::map<std::string, std::string> headers;     ///< names in lower case
  std::map<std::string, std::string> parameters;  ///< parts of the path that the route names
  std::string body;
  std::vector<FormPart> form;  ///< when the body is one

  /// The header's value, or "" when it is missing. `name` in lower case.
  std::string header(const std::string& name) const {
    const auto found = headers.find(name);
    return found == headers.end() ? "" : found->second;
  }
};

/// Appends the next part of a body to `out`; false when that was the last one.
using BodySource = std::function<bool(std::string& out)>;

struct HttpResponse {
  int status = 200;
  std::string content_type = "application/json";
  std::string body;
  std::vector<std::pair<std::string, std::string>> headers;

  // In place of `body`, for what is too large to be held:
  std::filesystem::path file = {};  ///< sent as it is, in parts if the client asks for ranges
  BodySource source = nullptr;      ///< of a length that nobody knows yet
  std::string route = {};  ///< the pattern that the request's path fits; the router fills it
};

}  // namespace stagger::server
