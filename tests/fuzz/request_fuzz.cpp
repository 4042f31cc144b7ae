// Paths, query strings and the headers that say who asks: "path\nname\nvalue\nhost\norigin". All of
// it is taken for a request's head, too.
#include <array>
#include <sstream>

#include "server/http/problem.h"
#include "server/http/request_head.h"
#include "server/http/router.h"
#include "server/http/routes/query.h"
#include "server/http/security.h"
#include "tests/fuzz/fuzz.h"

namespace stagger::server {
namespace {

Router small_router() {
  Router router;
  const auto paged = [](const HttpRequest& request) {
    QueryReader query(request);
    read_page(query);
    query.one_of("state", {"active", "done"});
    query.whole_or("since_tick", 0, 0, 1000);
    query.finish();
    return HttpResponse();
  };
  router.add("GET", "/api/v1/pushes", paged);
  router.add("GET", "/api/v1/pushes/{id}", paged);
  router.add("GET", "/api/v1/robots/{name}/files/{path...}", paged);
  return router;
}

}  // namespace
}  // namespace stagger::server

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  using namespace stagger::server;
  static const Router router = small_router();
  static const Gatekeeper gatekeeper("127.0.0.1", 8080);
  const std::string text = stagger::testing::text_of(data, size);
  body_length(text);
  std::istringstream lines(text);
  std::array<std::string, 5> part;
  for (std::string& each : part) std::getline(lines, each);
  HttpRequest request;
  request.method = "GET";
  request.path = part[0];
  request.query.emplace(part[1], part[2]);
  router.handle(request);
  gatekeeper.refusal(part[3], part[4]);
  why_no_host(part[3]);
  why_no_origin(part[4]);
  security_headers(part[3]);
  return 0;
}
