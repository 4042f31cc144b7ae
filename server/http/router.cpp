#include "server/http/router.h"

#include <spdlog/spdlog.h>

#include <optional>
#include <set>

#include "server/http/problem.h"

namespace stagger::server {
namespace {

std::vector<std::string> split(const std::string& path) {
  std::vector<std::string> parts;
  std::size_t start = 1;  // behind the leading slash
  while (start <= path.size()) {
    const std::size_t slash = std::min(path.find('/', start), path.size());
    parts.push_back(path.substr(start, slash - start));
    start = slash + 1;
  }
  return parts;
}

std::string joined(const std::vector<std::string>& parts, std::size_t from) {
  std::string path;
  for (std::size_t i = from; i < parts.size(); ++i) path += (i > from ? "/" : "") + parts[i];
  return path;
}

using Parameters = std::map<std::string, std::string>;

std::optional<Parameters> match(const std::vector<std::string>& pattern,
                                const std::vector<std::string>& path) {
  Parameters parameters;
  for (std::size_t i = 0; i < pattern.size(); ++i) {
    const std::string& part = pattern[i];
    if (part.ends_with("...}")) {
      if (i >= path.size()) return std::nullopt;
      parameters[part.substr(1, part.size() - 5)] = joined(path, i);
      return parameters;
    }
    if (i >= path.size()) return std::nullopt;
    if (part.starts_with('{')) {
      if (path[i].empty()) return std::nullopt;
      parameters[part.substr(1, part.size() - 2)] = path[i];
    } else if (part != path[i]) {
      return std::nullopt;
    }
  }
  if (path.size() != pattern.size()) return std::nullopt;
  return parameters;
}

}  // namespace

void Router::add(const std::string& method, const std::string& pattern, RouteHandler handler) {
  routes_.push_back({method, pattern, split(pattern), std::move(handler)});
}

std::vector<std::string> Router::table() const {
  std::vector<std::string> lines;
  lines.reserve(routes_.size());
  for (const Route& route : routes_) lines.push_back(route.method + " " + route.pattern);
  return lines;
}

HttpResponse Router::handle(HttpRequest request) const {
  std::string pattern;
  HttpResponse response = answer(request, pattern);
  response.route = std::move(pattern);
  return response;
}

HttpResponse Router::answer(HttpRequest& request, std::string& pattern) const {
  try {
    return dispatch(request, pattern);
  } catch (const Problem& problem) {
    return to_response(problem);
  } catch (const CommandError& error) {
    return to_response(to_problem(error));
  } catch (const std::exception& error) {
    spdlog::error("{} {}: {}", request.method, request.path, error.what());
    // What went wrong inside is for the log, not for whoever provoked it.
    return to_response(Problem(500, "an unexpected error; the server's log tells which"));
  }
}

HttpResponse Router::dispatch(HttpRequest& request, std::string& pattern) const {
  const std::string method = request.method == "HEAD" ? "GET" : request.method;
  const std::vector<std::string> path = split(request.path);
  std::set<std::string> allowed;
  for (const Route& route : routes_) {
    auto parameters = match(route.parts, path);
    if (!parameters) continue;
    pattern = route.pattern;
    if (route.method != method) {
      allowed.insert(route.method);
      continue;
    }
    request.parameters = std::move(*parameters);
    return route.handler(request);
  }
  if (allowed.empty() && !request.path.starts_with("/api/")) {
    if (method == "GET" && fallback_) return fallback_(request);
    allowed.insert("GET");
  }
  if (allowed.empty()) throw Problem(404, "there is nothing at " + request.path);
  std::string list;
  for (const std::string& name : allowed) {
    list += (list.empty() ? "" : ", ") + name;
    if (name == "GET") list += ", HEAD";
  }
  throw Problem(405, request.method + " is not possible at " + request.path + "; allowed: " + list)
      .with_header("Allow", list);
}

}  // namespace stagger::server
