// Finds the handler for a method and a path; tells 404 from 405.
#pragma once

#include <functional>
#include <string>
#include <utility>
#include <vector>

#include "server/http/message.h"

namespace stagger::server {

using RouteHandler = std::function<HttpResponse(const HttpRequest&)>;

class Router {
 public:
  /// `pattern` is a path whose parts may be "{name}"; "{name...}" takes all that is left.
  void add(const std::string& method, const std::string& pattern, RouteHandler handler);

  /// Answers GET where no route's path fits (files of the dashboard).
  void set_fallback(RouteHandler handler) { fallback_ = std::move(handler); }

  /// "GET /api/v1/pushes/{id}" and so on, in the order in which they were added.
  std::vector<std::string> table() const;

  /// Answers any request; what a handler throws becomes a problem. HEAD is answered as GET.
  HttpResponse handle(HttpRequest request) const;

 private:
  struct Route {
    std::string method;
    std::string pattern;
    std::vector<std::string> parts;
    RouteHandler handler;
  };
  HttpResponse answer(HttpRequest& request, std::string& pattern) const;
  HttpResponse dispatch(HttpRequest& request, std::string& pattern) const;

  std::vector<Route> routes_;
  RouteHandler fallback_;
};

}  // namespace stagger::server
