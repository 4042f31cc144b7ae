#include "server/campaign/results.h"

#include <sstream>
#include <utility>

#include "server/live/ticket.h"

namespace stagger::server::campaign {
namespace {

bool is_lines(OutputFile file) { return file == OutputFile::csv || file == OutputFile::ndjson; }

}  // namespace

// Lines are read page by page, each trial being right by itself: no transaction is open while a
// slow reader is waited for, for which SQLite's log would have to keep all that comes. A summary
// is read several times over, and its numbers have to fit each other.
Store::Access ResultsReader::access_for(OutputFile file) {
  return is_lines(file) ? Store::Access::read : Store::Access::snapshot;
}

Results ResultsReader::read(const Folder& folder, OutputFile file, std::shared_ptr<const Plan> plan,
                            std::shared_ptr<const Store> store) {
  Results results;
  if (is_lines(file)) {
    const auto format =
        file == OutputFile::csv ? TrialLines::Format::csv : TrialLines::Format::ndjson;
    const auto lines = std::make_shared<TrialLines>(*plan, *store, format);
    results.pieces = [this, plan = std::move(plan), store = std::move(store),
                      lines](std::string& out) {
      const std::lock_guard lock(one_piece_);
      return lines->next(out);
    };
    return results;
  }
  const std::unique_lock lock(one_text_, std::try_to_lock);
  if (!lock.owns_lock()) {
    throw CommandError(CommandError::Kind::busy,
                       "results of a campaign that is not done are being made for somebody else");
  }
  std::ostringstream out;
  folder.write(file, out, *plan, *store, summarize(*plan, *store));
  results.text = std::move(out).str();
  return results;
}

}  // namespace stagger::server::campaign
