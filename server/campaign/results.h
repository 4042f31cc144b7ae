// What a campaign has found so far, read from its store while others may write it.
#pragma once

#include <filesystem>
#include <functional>
#include <memory>
#include <mutex>
#include <string>

#include "server/campaign/folder.h"

namespace stagger::server::campaign {

/// A file, or else a text, or else one that is made while it is read.
struct Results {
  std::filesystem::path file;
  std::string text;
  /// Appends the next piece to `out`; false when that was the last one.
  std::function<bool(std::string& out)> pieces;
  bool partial = false;  ///< the campaign is not done: trials may be missing
};

/// Makes for readers what a campaign's files would hold if it ended now, with no more than two
/// threads at work however many readers there are. May be used by several threads; outlives the
/// results.
class ResultsReader {
 public:
  /// How the store is to be opened for that file.
  static Store::Access access_for(OutputFile file);
  /// Lines of trials come in pieces, and nothing waits for who reads them slowly: all the trials
  /// that are stored now, maybe some that come meanwhile. The rest is one text. Throws CommandError
  /// (busy) when such a text is being made already.
  Results read(const Folder& folder, OutputFile file, std::shared_ptr<const Plan> plan,
               std::shared_ptr<const Store> store);

 private:
  std::mutex one_piece_;
  std::mutex one_text_;
};

}  // namespace stagger::server::campaign
