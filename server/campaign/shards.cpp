#include "server/campaign/shards.h"

#include <algorithm>
#include <set>

namespace stagger::server::campaign {
namespace {

namespace fs = std::filesystem;

fs::path shards_folder(const Folder& folder) { return folder.path() / "shards"; }

std::string shard_prefix(const Shard& shard) {
  return "round-" + std::to_string(shard.round) + "-shard-" + std::to_string(shard.index) + "-";
}

/// A file that was being made when its process was killed holds nothing.
bool is_store(const fs::path& file) { return file.extension() == ".sqlite"; }

std::vector<fs::path> files_with(const Folder& folder, const std::string& prefix) {
  std::vector<fs::path> files;
  std::error_code error;
  for (const auto& each : fs::directory_iterator(shards_folder(folder), error)) {
    const std::string name = each.path().filename().string();
    if (name.starts_with(prefix) && is_store(each.path())) files.push_back(each.path());
  }
  std::sort(files.begin(), files.end());
  return files;
}

/// What a dead disk or machine has left unreadable is as good as not run: false.
bool merge_readable(Store& into, const fs::path& file) {
  try {
    // With the right to write: SQLite may have to undo what a killed process has left half done.
    into.merge(Store(file, Store::Access::write));
    return true;
  } catch (const SqliteError&) {
    return false;
  }
}

}  // namespace

Round pending_trials(const Plan& plan, const Store& store) {
  const Round wanted = plan.design().next_round(store);
  std::vector<std::uint64_t> missing;
  for (std::uint64_t i = 0; i < wanted.size(); ++i) {
    if (!store.verdict(wanted[i])) missing.push_back(wanted[i]);
  }
  return Round::list(std::move(missing));
}

fs::path shard_file(const Folder& folder, const Shard& shard, const std::string& attempt) {
  return shards_folder(folder) / (shard_prefix(shard) + attempt + ".sqlite");
}

std::vector<fs::path> shard_files(const Folder& folder) { return files_with(folder, "round-"); }

std::uint64_t run_shard(const Folder& folder, const Plan& plan, const Shard& shard,
                        const std::string& attempt, const RunnerOptions& options) {
  const Store whole(folder.store(), Store::Access::read);
  const Round share = pending_trials(plan, whole).share(shard.index, shard.count);
  const fs::path file = shard_file(folder, shard, attempt);
  fs::create_directories(file.parent_path());
  const std::vector<fs::path> earlier = files_with(folder, shard_prefix(shard));
  if (!fs::exists(file)) {
    const fs::path unfinished = file.string() + ".part";
    fs::remove(unfinished);
    Store::create(unfinished, whole.specification(), Store::Journal::rollback);
    fs::rename(unfinished, file);
  }
  Store store(file, Store::Access::write);
  for (const fs::path& other : earlier) {
    if (other != file) merge_readable(store, other);
  }
  run_round(plan, share, store, options);
  std::uint64_t left = 0;
  for (std::uint64_t i = 0; i < share.size(); ++i) {
    if (!store.verdict(share[i])) ++left;
  }
  return left;
}

Merged merge_shards(const Folder& folder, Store& store) {
  const std::uint64_t before = store.count();
  Merged merged;
  for (const fs::path& file : shard_files(folder)) {
    if (!merge_readable(store, file)) merged.unreadable.push_back(file);
  }
  merged.fresh = store.count() - before;
  return merged;
}

std::uint64_t trials_under_way(const Folder& folder, const Store& store) {
  std::set<std::uint64_t> numbers;
  for (const fs::path& file : shard_files(folder)) {
    Store(file, Store::Access::read).for_each([&](const Record& record) {
      if (!store.verdict(record.number)) numbers.insert(record.number);
    });
  }
  return numbers.size();
}

}  // namespace stagger::server::campaign
