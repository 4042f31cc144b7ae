#include "server/recording/export.h"

#include <cmath>

#include "server/json/stream_data.h"
#include "server/json/stream_json.h"
#include "sim/state_hash.h"

namespace stagger::server {
namespace {

constexpr std::size_t part_bytes = 1 << 16;

std::string quoted(const std::string& text) {
  if (text.find_first_of(",\"\n") == std::string::npos) return text;
  std::string result = "\"";
  for (const char c : text) result += c == '"' ? std::string("\"\"") : std::string(1, c);
  return result + '"';
}

}  // namespace

Export::Export(const std::filesystem::path& file, ExportFormat format, const Selection& selection,
               sim::JsonErrors& errors)
    : format_(format),
      reader_(file),
      window_(file, selection),
      chosen_(choose_columns(file, selection, errors)) {}

bool Export::next(std::string& out) {
  if (!started_) {
    started_ = true;
    if (format_ == ExportFormat::csv) write_header(out);
  }
  const std::size_t enough = out.size() + part_bytes;
  while (!window_.past_end() && out.size() < enough) {
    const auto item = reader_.next();
    if (!item) return false;
    std::visit([&](const auto& some) { write(some, out); }, *item);
  }
  return !window_.past_end();
}

void Export::write_header(std::string& out) {
  out += "elapsed [s],world,tick,time [s]";
  if (chosen_.with_hash) out += ",state_hash";
  for (const RecordedColumn& column : chosen_.columns) {
    out += ',' + quoted(column.label + " [" + column.unit + "]");
  }
  out += "\r\n";
}

void Export::write(const RecordedWorld& world, std::string& out) {
  world_ = world.number;
  if (format_ != ExportFormat::ndjson) return;
  out += R"({"op":"world","world":)" + std::to_string(world.number) + R"(,"session_id":)" +
         to_text(Json(world.session_id)) + R"(,"version":)" + to_text(Json(world.version)) +
         R"(,"config":)" + world.text + "}\n";
}

void Export::write(const RecordedText& text, std::string& out) {
  if (format_ != ExportFormat::ndjson) return;
  if (text.is_command) {
    out += R"({"op":"command",)" + text.text.substr(1) + '\n';
  } else if (window_.takes(text)) {
    out += text.text + '\n';
  }
}

void Export::write(const RecordedTick& tick, std::string& out) {
  if (!window_.takes(tick)) return;
  look_up(*tick.schema);
  const double elapsed = window_.elapsed(tick.time_ns);
  if (format_ == ExportFormat::csv) {
    write_csv(tick, elapsed, out);
  } else {
    write_ndjson(tick, elapsed, out);
  }
}

void Export::look_up(const FrameSchema& schema) {
  if (schema_ == &schema) return;
  schema_ = &schema;
  places_ = places_in(schema, chosen_.columns);
}

const double* Export::value(const RecordedTick& tick, std::size_t column) const {
  if (!places_[column]) return nullptr;
  const std::vector<double>& values = tick.frame.values[*places_[column]];
  const std::size_t at = chosen_.columns[column].at;
  return at < values.size() ? &values[at] : nullptr;
}

void Export::write_csv(const RecordedTick& tick, double elapsed, std::string& out) {
  append_number(out, elapsed);
  out += ',' + std::to_string(world_) + ',' + std::to_string(tick.frame.tick) + ',';
  append_number(out, tick.frame.time);
  if (chosen_.with_hash) out += ',' + sim::to_hex(tick.frame.state_hash);
  for (std::size_t i = 0; i < chosen_.columns.size(); ++i) {
    out += ',';
    const double* number = value(tick, i);
    if (number != nullptr && std::isfinite(*number)) append_number(out, *number);
  }
  out += "\r\n";
}

void Export::write_ndjson(const RecordedTick& tick, double elapsed, std::string& out) {
  out += R"({"op":"data","elapsed":)";
  append_number(out, elapsed);
  out += R"(,"world":)" + std::to_string(world_) + R"(,"tick":)" + std::to_string(tick.frame.tick) +
         R"(,"t":)";
  append_number(out, tick.frame.time);
  if (chosen_.with_hash) out += R"(,"state_hash":")" + sim::to_hex(tick.frame.state_hash) + '"';
  out += R"(,"v":{)";
  const char* comma = "";
  for (std::size_t i = 0; i < chosen_.columns.size(); ++i) {
    const double* number = value(tick, i);
    if (number == nullptr) continue;
    out += comma;
    out += to_text(Json(chosen_.columns[i].label)) + ':';
    append_number(out, *number);
    comma = ",";
  }
  out += "}}\n";
}

}  // namespace stagger::server
