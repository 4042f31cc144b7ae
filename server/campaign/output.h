// The files that a campaign leaves for people and other programs.
#pragma once

#include <array>
#include <iosfwd>
#include <string>
#include <vector>

#include "server/campaign/summary.h"

namespace stagger::server::campaign {

enum class OutputFile : std::uint8_t { summary, csv, ndjson, junit, report };
inline constexpr std::array output_files{OutputFile::summary, OutputFile::csv, OutputFile::ndjson,
                                         OutputFile::junit, OutputFile::report};
/// "summary.json" and so on.
std::string file_name(OutputFile file);

/// The trials as lines, a page at a time: others may add trials meanwhile.
class TrialLines {
 public:
  enum class Format : std::uint8_t { csv, ndjson };
  /// Both have to outlive it.
  TrialLines(const Plan& plan, const Store& store, Format format);

  /// Appends the lines of the next Store::page_size trials; false when these were the last.
  bool next(std::string& out);

 private:
  void append_csv(const Record& record, std::string& out) const;

  const Plan& plan_;
  const Store& store_;
  const Format format_;
  std::vector<std::string> paths_;  ///< of the fields that the campaign sets
  std::uint64_t from_ = 0;
  bool begun_ = false;
};

/// One line a trial, by number, with a column for each field that the campaign sets. Numbers have
/// all their digits; the same campaign gives the same bytes.
void write_csv(std::ostream& out, const Plan& plan, const Store& store);

/// One trial as JSON, with what `stagger trial` reads in "spec".
Json record_json(const Plan& plan, const Record& record);

/// One such object a line, by number.
void write_ndjson(std::ostream& out, const Plan& plan, const Store& store);

/// Thresholds and repeatability as test cases, for continuous integration.
void write_junit(std::ostream& out, const Plan& plan, const Summary& summary);

}  // namespace stagger::server::campaign
