#include "server/campaign/output.h"

#include <ostream>
#include <set>

#include "server/json/trial_json.h"
#include "sim/state_hash.h"

namespace stagger::server::campaign {
namespace {

/// Quoted where a comma, a quotation mark or a line's end would mislead (RFC 4180).
std::string csv_text(const std::string& text) {
  if (text.find_first_of(",\"\r\n") == std::string::npos) return text;
  std::string quoted = "\"";
  for (const char c : text) {
    if (c == '"') quoted += '"';
    quoted += c;
  }
  return quoted + '"';
}

std::string csv_value(const Json& value) {
  if (value.is_null()) return {};
  return csv_text(value.is_string() ? value.get<std::string>() : to_text(value));
}

/// The fields that any trial of the campaign sets, in the order in which they are set.
std::vector<std::string> paths_of(const Plan& plan) {
  const CampaignSpec& spec = plan.spec();
  std::vector<std::string> paths;
  std::set<std::string> known;
  const auto add = [&](const std::string& path) {
    if (known.insert(path).second) paths.push_back(path);
  };
  if (!spec.design.entries.empty()) add("name");
  for (const Entry& entry : spec.design.entries) {
    for (const auto& [path, value] : entry.settings) add(path);
  }
  for (const Factor& factor : spec.factors) add(factor.path);
  if (plan.design().is_bisection()) add(spec.design.bisection.axis);
  return paths;
}

/// The columns of one trial after those that the campaign sets.
Json result_fields(const Record& record) {
  const sim::TrialResult& r = record.result;
  return {{"outcome", server::name_of(r.outcome)},
          {"passed", record.passed},
          {"reason", r.reason},
          {"impulse_ns", record.push.impulse_ns},
          {"force_n", record.push.force_n},
          {"delta_v", record.push.delta_v},
          {"fr", record.push.fr},
          {"ceiling_dv", or_null(record.ceiling_dv)},
          {"delivered_ns", r.delivered_ns},
          {"push_tick", or_null(r.push_tick)},
          {"steps_to_recover", or_null(r.steps_to_recover)},
          {"recovery_time_s", or_null(r.recovery_time_s)},
          {"fall_time_s", or_null(r.fall_time_s)},
          {"worst_dcm_error_m", r.worst_dcm_error_m},
          {"ticks", r.ticks},
          {"state_hash", sim::to_hex(r.state_hash)},
          {"run_twice", record.repeated.has_value()}};
}

std::string csv_head(const std::vector<std::string>& paths) {
  std::string head = "number,id,seed,repeat";
  for (const std::string& path : paths) head += ',' + csv_text(path);
  const Json any = result_fields({});
  for (const auto& [name, value] : any.items()) head += ',' + name;
  return head + '\n';
}

void write_lines(std::ostream& out, TrialLines lines) {
  bool more = true;
  while (more) {
    std::string text;
    more = lines.next(text);
    out << text;
  }
}

std::string xml_text(const std::string& text) {
  std::string escaped;
  for (const char c : text) {
    switch (c) {
      case '&':
        escaped += "&amp;";
        break;
      case '<':
        escaped += "&lt;";
        break;
      case '>':
        escaped += "&gt;";
        break;
      case '"':
        escaped += "&quot;";
        break;
      default:
        // XML has no way to write control characters.
        escaped += static_cast<unsigned char>(c) < 0x20 ? ' ' : c;
    }
  }
  return escaped;
}

struct TestCase {
  std::string name;
  std::string failure;  ///< empty: it passed
};

std::vector<TestCase> cases_of(const Summary& summary) {
  std::vector<TestCase> cases;
  for (const ThresholdResult& result : summary.thresholds) {
    const std::string value = result.value ? Json(*result.value).dump() : "not known";
    cases.push_back({result.text, result.passed ? "" : "the value is " + value});
  }
  std::string mismatches;
  for (const std::uint64_t number : summary.mismatches) mismatches += " " + std::to_string(number);
  cases.push_back(
      {"trials repeat to the bit", mismatches.empty() ? "" : "these trials did not:" + mismatches});
  cases.push_back({"no trial is invalid",
                   summary.counts.invalid == 0
                       ? ""
                       : std::to_string(summary.counts.invalid) + " trials are invalid"});
  cases.push_back({"all trials have been run",
                   summary.state == State::incomplete
                       ? std::to_string(summary.counts.trials) + " trials have been run, not all"
                       : ""});
  return cases;
}

}  // namespace

std::string file_name(OutputFile file) {
  switch (file) {
    case OutputFile::summary:
      return "summary.json";
    case OutputFile::csv:
      return "trials.csv";
    case OutputFile::ndjson:
      return "trials.ndjson";
    case OutputFile::junit:
      return "junit.xml";
    case OutputFile::report:
      break;
  }
  return "report.html";
}

TrialLines::TrialLines(const Plan& plan, const Store& store, Format format)
    : plan_(plan), store_(store), format_(format), paths_(paths_of(plan)) {}

bool TrialLines::next(std::string& out) {
  if (!begun_ && format_ == Format::csv) out += csv_head(paths_);
  begun_ = true;
  const std::vector<Record> records = store_.page(from_);
  for (const Record& record : records) {
    if (format_ == Format::csv) {
      append_csv(record, out);
    } else {
      out += to_text(record_json(plan_, record)) + '\n';
    }
  }
  if (!records.empty()) from_ = records.back().number + 1;
  return records.size() == Store::page_size;
}

void TrialLines::append_csv(const Record& record, std::string& out) const {
  out += std::to_string(record.number) + ',' + record.id + ',' + std::to_string(record.seed) + ',' +
         std::to_string(record.repeat);
  const Json values = Json::parse(record.values);
  for (const std::string& path : paths_) {
    const auto found = values.find(path);
    out += ',' + (found == values.end() ? "" : csv_value(*found));
  }
  const Json fields = result_fields(record);
  for (const auto& [name, value] : fields.items()) out += ',' + csv_value(value);
  out += '\n';
}

void write_csv(std::ostream& out, const Plan& plan, const Store& store) {
  write_lines(out, {plan, store, TrialLines::Format::csv});
}

Json record_json(const Plan& plan, const Record& record) {
  Json fields{{"number", record.number},
              {"id", record.id},
              {"seed", record.seed},
              {"repeat", record.repeat},
              {"values", Json::parse(record.values)}};
  fields.update(result_fields(record));
  fields["spec"] = plan.trial(record.number).resolved;
  return fields;
}

void write_ndjson(std::ostream& out, const Plan& plan, const Store& store) {
  write_lines(out, {plan, store, TrialLines::Format::ndjson});
}

void write_junit(std::ostream& out, const Plan& plan, const Summary& summary) {
  const std::string name = xml_text(plan.spec().name);
  const std::vector<TestCase> cases = cases_of(summary);
  std::size_t failures = 0;
  for (const TestCase& test : cases) failures += test.failure.empty() ? 0 : 1;
  out << "<?xml version=\"1.0\" encoding=\"UTF-8\"?>\n"
      << "<testsuites><testsuite name=\"" << name << "\" tests=\"" << cases.size()
      << "\" failures=\"" << failures << "\" errors=\"0\" skipped=\"0\">\n";
  for (const TestCase& test : cases) {
    out << "  <testcase classname=\"" << name << "\" name=\"" << xml_text(test.name) << '"';
    if (test.failure.empty()) {
      out << "/>\n";
    } else {
      out << "><failure message=\"" << xml_text(test.failure) << "\"/></testcase>\n";
    }
  }
  out << "</testsuite></testsuites>\n";
}

}  // namespace stagger::server::campaign
