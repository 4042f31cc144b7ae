#include <array>
#include <memory>
#include <utility>

#include "server/http/idempotency.h"
#include "server/http/problem.h"
#include "server/http/routes/body.h"
#include "server/http/routes/query.h"
#include "server/http/routes/routes.h"
#include "server/json/campaign_json.h"

namespace stagger::server {
namespace {

struct ResultFormat {
  const char* name;
  campaign::OutputFile file;
  const char* type;
};
constexpr std::array<ResultFormat, 5> result_formats{
    {{"csv", campaign::OutputFile::csv, "text/csv; charset=utf-8"},
     {"ndjson", campaign::OutputFile::ndjson, "application/x-ndjson"},
     {"junit", campaign::OutputFile::junit, "application/xml"},
     {"html", campaign::OutputFile::report, "text/html; charset=utf-8"},
     {"json", campaign::OutputFile::summary, "application/json"}}};

std::uint64_t campaign_id(const HttpRequest& request) {
  const std::string& text = request.parameters.at("id");
  const auto id = whole_number(text);
  if (!id) throw Problem(404, "there is no campaign \"" + text + "\"");
  return *id;
}

HttpResponse answer_with(const campaign::QueueItem& item, int status) {
  HttpResponse response = json_response(campaign_json(item), status);
  if (status == 202) {
    response.headers.emplace_back("Location", "/api/v1/campaigns/" + std::to_string(item.id));
  }
  return response;
}

HttpResponse submit(const HttpRequest& request, Services& services) {
  json_body(request);  // is it JSON, by name and content?
  try {
    return answer_with(services.campaigns.add(request.body), 202);
  } catch (const campaign::SpecRefused& refused) {
    throw Problem(refused.errors);
  }
}

HttpResponse list_campaigns(const HttpRequest& request, Services& services) {
  QueryReader query(request);
  const PageQuery page = read_page(query);
  const auto state = query.one_of(
      "state", {"queued", "running", "cancelling", "done", "cancelled", "interrupted", "failed"});
  query.finish();
  // One more than asked for tells whether there is another page.
  auto found = services.campaigns.list(page.before, page.limit + 1,
                                       state ? campaign::queue_state_of(*state) : std::nullopt);
  Json next = nullptr;
  if (found.size() > page.limit) {
    found.pop_back();
    next = std::to_string(found.back().id);
  }
  Json items = Json::array();
  for (const campaign::QueueItem& item : found) items.push_back(campaign_json(item));
  return json_response({{"items", std::move(items)}, {"next_cursor", std::move(next)}});
}

/// What the client would rather have, when it does not say ?format.
std::string accepted_format(const std::string& accept) {
  for (const ResultFormat& format : result_formats) {
    const std::string type(format.type);
    if (accept.find(type.substr(0, type.find(';'))) != std::string::npos) return format.name;
  }
  return "csv";
}

HttpResponse results(const HttpRequest& request, Services& services) {
  const std::uint64_t id = campaign_id(request);
  QueryReader query(request);
  std::vector<std::string> names;
  names.reserve(result_formats.size());
  for (const ResultFormat& format : result_formats) names.emplace_back(format.name);
  const auto asked = query.one_of("format", names);
  query.finish();
  const std::string name = asked.value_or(accepted_format(request.header("accept")));
  for (const ResultFormat& format : result_formats) {
    if (name != format.name) continue;
    campaign::Results found = services.campaigns.results(id, format.file);
    HttpResponse response;
    response.content_type = format.type;
    response.file = std::move(found.file);
    response.body = std::move(found.text);
    response.source = std::move(found.pieces);
    const std::string file = std::to_string(id) + "-" + campaign::file_name(format.file);
    response.headers = {{"Content-Disposition", "attachment; filename=\"" + file + "\""},
                        {"Cache-Control", "no-store"}};
    if (found.partial) response.headers.emplace_back("Results-Partial", "true");
    return response;
  }
  throw Problem(404, "there is no such format");
}

}  // namespace

void add_campaign_routes(Router& router, Services& services) {
  const std::string base = "/api/v1/campaigns";
  const std::string one = base + "/{id}";
  const auto idempotency = std::make_shared<Idempotency>();
  router.add("POST", base, [&, idempotency](const HttpRequest& request) {
    return idempotency->run(request, [&] { return submit(request, services); });
  });
  router.add("GET", base,
             [&](const HttpRequest& request) { return list_campaigns(request, services); });
  router.add("GET", one, [&](const HttpRequest& request) {
    return answer_with(services.campaigns.find(campaign_id(request)), 200);
  });
  router.add("DELETE", one, [&](const HttpRequest& request) {
    expect_no_fields(request);
    services.campaigns.remove(campaign_id(request));
    return HttpResponse{204, "", "", {}};
  });
  router.add("POST", one + "/cancel", [&](const HttpRequest& request) {
    expect_no_fields(request);
    return answer_with(services.campaigns.cancel(campaign_id(request)), 202);
  });
  router.add("POST", one + "/resume", [&](const HttpRequest& request) {
    expect_no_fields(request);
    return answer_with(services.campaigns.resume(campaign_id(request)), 202);
  });
  router.add("GET", one + "/results",
             [&](const HttpRequest& request) { return results(request, services); });
}

}  // namespace stagger::server
