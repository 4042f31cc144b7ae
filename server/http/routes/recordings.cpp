#include <charconv>
#include <memory>
#include <sstream>

#include "server/http/problem.h"
#include "server/http/routes/body.h"
#include "server/http/routes/routes.h"
#include "server/json/recording_json.h"
#include "server/recording/export.h"
#include "server/recording/mcap_cut.h"

namespace stagger::server {
namespace {

constexpr std::uint64_t max_limit = 1000;
constexpr std::size_t most_fields = 512;

const std::string& id_of(const HttpRequest& request) { return request.parameters.at("id"); }

std::optional<double> number_of(const std::string& text) {
  double value = 0.0;
  const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), value);
  if (error != std::errc() || end != text.data() + text.size() || !std::isfinite(value)) {
    return std::nullopt;
  }
  return value;
}

HttpResponse create_recording(const HttpRequest& request, Services& services) {
  RecordingRequest wanted;
  read_body(request, true,
            [&wanted](sim::JsonReader& reader) { wanted = read_recording_request(reader); });
  const RecordingInfo info = services.recorder.start(wanted);
  HttpResponse response = json_response(recording_json(info), 201);
  response.headers.emplace_back("Location", "/api/v1/recordings/" + info.id);
  return response;
}

CatalogueQuery read_query(const HttpRequest& request) {
  CatalogueQuery query;
  sim::JsonErrors errors;
  for (const auto& [name, text] : request.query) {
    if (name == "limit") {
      const auto limit = whole_number(text);
      if (!limit || *limit < 1 || *limit > max_limit) {
        errors.add("/limit", "is \"" + text + "\"; allowed: 1 to " + std::to_string(max_limit));
      } else {
        query.limit = static_cast<std::size_t>(*limit);
      }
    } else if (name == "cursor") {
      query.before = text;
    } else if (name == "tag") {
      query.tag = text;
    } else if (name == "state") {
      query.state = recording_state_of(text);
      if (!query.state) {
        errors.add("/state", "is \"" + text + R"("; allowed: "armed", "recording", "done")");
      }
    } else if (name == "reason") {
      query.reason = recording_reason_of(text);
      if (!query.reason) {
        errors.add("/reason", "is \"" + text + R"("; allowed: "manual", "push", "fall")");
      }
    } else {
      errors.add("/" + name, "is unknown; known: limit, cursor, tag, state, reason");
    }
  }
  if (!errors.empty()) throw Problem(errors);
  return query;
}

HttpResponse list_recordings(const HttpRequest& request, Services& services) {
  CatalogueQuery query = read_query(request);
  const std::size_t limit = query.limit;
  // One more than asked for tells whether there is another page.
  ++query.limit;
  auto found = services.recorder.list(query);
  Json next = nullptr;
  if (found.size() > limit) {
    found.resize(limit);
    next = found.back().id;
  }
  Json items = Json::array();
  for (const RecordingInfo& info : found) items.push_back(recording_json(info));
  return json_response({{"items", std::move(items)},
                        {"next_cursor", std::move(next)},
                        {"disk", disk_use_json(services.recorder.disk_use())}});
}

HttpResponse change_recording(const HttpRequest& request, Services& services) {
  RecordingPatch patch;
  read_body(request, false,
            [&patch](sim::JsonReader& reader) { patch = read_recording_patch(reader); });
  return json_response(recording_json(services.recorder.change(id_of(request), patch)));
}

struct DataQuery {
  std::string format;
  bool selects = false;
  Selection selection;
};

void read_number(const std::string& name, const std::string& text, double& value,
                 sim::JsonErrors& errors) {
  const auto number = number_of(text);
  if (!number || *number < 0.0) {
    errors.add("/" + name, "is \"" + text + "\"; allowed: at least 0 s");
  } else {
    value = *number;
  }
}

DataQuery read_data_query(const HttpRequest& request, sim::JsonErrors& errors) {
  DataQuery query;
  const std::string accept = request.header("accept");
  query.format = accept.find("text/csv") != std::string::npos ? "csv"
                 : accept.find("ndjson") != std::string::npos ? "ndjson"
                                                              : "mcap";
  for (const auto& [name, text] : request.query) {
    if (name == "format") {
      query.format = text;
      if (text != "csv" && text != "ndjson" && text != "mcap") {
        errors.add("/format", "is \"" + text + R"("; allowed: "mcap", "csv", "ndjson")");
      }
      continue;
    }
    query.selects = true;
    if (name == "fields") {
      std::vector<std::string> fields;
      std::istringstream in(text);
      for (std::string field; std::getline(in, field, ',');) fields.push_back(field);
      if (fields.empty() || fields.size() > most_fields) {
        errors.add("/fields", "names " + std::to_string(fields.size()) + "; allowed: 1 to " +
                                  std::to_string(most_fields));
      }
      query.selection.fields = std::move(fields);
    } else if (name == "from") {
      read_number(name, text, query.selection.from_s, errors);
    } else if (name == "to") {
      read_number(name, text, query.selection.to_s, errors);
    } else if (name == "every") {
      const auto every = whole_number(text);
      if (!every || *every < 1) errors.add("/every", "is \"" + text + "\"; allowed: 1 or more");
      query.selection.every = std::max<std::uint64_t>(every.value_or(1), 1);
    } else {
      errors.add("/" + name, "is unknown; known: format, fields, from, to, every");
    }
  }
  return query;
}

/// Made while it is sent.
BodySource source_of(const std::filesystem::path& file, const DataQuery& query,
                     sim::JsonErrors& errors) {
  if (query.format == "mcap") {
    return [cut = std::make_shared<McapCut>(file, query.selection, errors)](std::string& out) {
      return cut->next(out);
    };
  }
  const auto format = query.format == "csv" ? ExportFormat::csv : ExportFormat::ndjson;
  return [text = std::make_shared<Export>(file, format, query.selection, errors)](
             std::string& out) { return text->next(out); };
}

const char* content_type_of(const std::string& format) {
  if (format == "csv") return "text/csv; charset=utf-8";
  return format == "ndjson" ? "application/x-ndjson" : "application/octet-stream";
}

HttpResponse data(const HttpRequest& request, Services& services) {
  const std::string& id = id_of(request);
  sim::JsonErrors errors;
  const DataQuery query = read_data_query(request, errors);
  const bool finished = services.recorder.find(id).state == RecordingState::done;
  const std::filesystem::path file = services.recorder.file_of(id);
  if (!errors.empty()) throw Problem(errors);
  HttpResponse response;
  response.content_type = content_type_of(query.format);
  const std::string ending =
      (query.selects && query.format == "mcap" ? "-cut." : ".") + query.format;
  response.headers = {{"Content-Disposition", "attachment; filename=\"" + id + ending + "\""},
                      {"Cache-Control", "no-store"},
                      {"Recording-Finished", finished ? "true" : "false"}};
  // What is still written has no index yet: it is sent as one that ends here.
  if (query.format == "mcap" && finished && !query.selects) {
    response.file = file;
    return response;
  }
  try {
    response.source = source_of(file, query, errors);
  } catch (const std::runtime_error&) {
    if (finished) throw;
    throw Problem(409, "nothing of recording " + id + " is written yet");
  }
  if (!errors.empty()) throw Problem(errors);
  return response;
}

}  // namespace

void add_recording_routes(Router& router, Services& services) {
  const std::string base = "/api/v1/recordings";
  const std::string one = base + "/{id}";
  router.add("GET", base,
             [&](const HttpRequest& request) { return list_recordings(request, services); });
  router.add("POST", base,
             [&](const HttpRequest& request) { return create_recording(request, services); });
  router.add("GET", one, [&](const HttpRequest& request) {
    return json_response(recording_json(services.recorder.find(id_of(request))));
  });
  router.add("PATCH", one,
             [&](const HttpRequest& request) { return change_recording(request, services); });
  router.add("DELETE", one, [&](const HttpRequest& request) {
    const RecordingInfo info = services.recorder.find(id_of(request));
    services.recorder.remove(info.id);
    return json_response(recording_json(info));
  });
  router.add("POST", one + "/stop", [&](const HttpRequest& request) {
    expect_no_fields(request);
    return json_response(recording_json(services.recorder.stop(id_of(request))));
  });
  router.add("GET", one + "/data",
             [&](const HttpRequest& request) { return data(request, services); });
}

}  // namespace stagger::server
