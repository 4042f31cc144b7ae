#include "server/campaign/campaign_queue.h"

#include <sys/resource.h>
#include <unistd.h>

#include <algorithm>
#include <array>
#include <charconv>
#include <fstream>
#include <iterator>
#include <set>
#include <utility>

#include "server/campaign/folder.h"
#include "server/campaign/plan_check.h"
#include "server/json/json.h"
#include "server/live/ticket.h"
#include "sim/json_file.h"

namespace stagger::server::campaign {
namespace {

namespace fs = std::filesystem;
using Clock = std::chrono::steady_clock;
using Kind = CommandError::Kind;

constexpr const char* state_file = "state.json";
constexpr const char* lock_file = "queue.lock";
constexpr std::chrono::seconds lock_patience{5};
constexpr std::chrono::seconds telling_period{1};

constexpr std::array<std::pair<QueueState, std::string_view>, 7> state_names{
    {{QueueState::queued, "queued"},
     {QueueState::running, "running"},
     {QueueState::cancelling, "cancelling"},
     {QueueState::done, "done"},
     {QueueState::cancelled, "cancelled"},
     {QueueState::interrupted, "interrupted"},
     {QueueState::failed, "failed"}}};

bool is_active(QueueState state) {
  return state == QueueState::queued || state == QueueState::running ||
         state == QueueState::cancelling;
}

std::unique_ptr<Plan> plan_of(const std::string& text, RobotLibrary& library) {
  sim::JsonErrors errors;
  auto plan = std::unique_ptr<Plan>();
  CampaignSpec spec = read_campaign(sim::parse_json(text), errors);
  if (errors.empty()) {
    plan = std::make_unique<Plan>(std::move(spec), library);
    check_plan(*plan, errors);
  }
  if (errors.empty() && plan->design().most_trials() > CampaignQueue::most_trials) {
    errors.add("/design", "could need " + std::to_string(plan->design().most_trials()) +
                              " trials; allowed here: 1 to " +
                              std::to_string(CampaignQueue::most_trials));
  }
  if (!errors.empty()) throw SpecRefused(std::move(errors));
  return plan;
}

/// All cores but one, which is the live simulation's.
unsigned worker_threads() { return std::max(2U, std::thread::hardware_concurrency()) - 1; }

/// Of this thread and of those that it makes: they get what the others leave.
void yield_to_others() {
  constexpr int lowest = 19;
  setpriority(PRIO_PROCESS, static_cast<id_t>(gettid()), lowest);
}

std::optional<std::uint64_t> id_of(const fs::path& folder) {
  const std::string text = folder.filename().string();
  std::uint64_t id = 0;
  const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), id);
  const bool whole = error == std::errc() && end == text.data() + text.size();
  return whole ? std::optional(id) : std::nullopt;
}

/// What save() has written; one that is missing tells of no campaign that ended.
std::string saved_state(const fs::path& folder) {
  std::ifstream in(folder / state_file);
  return in ? std::string(std::istreambuf_iterator<char>(in), {}) : "{}";
}

}  // namespace

std::string_view name_of(QueueState state) {
  const auto* const found = std::find_if(state_names.begin(), state_names.end(),
                                         [&](const auto& item) { return item.first == state; });
  return found->second;
}

std::optional<QueueState> queue_state_of(std::string_view name) {
  const auto* const found = std::find_if(state_names.begin(), state_names.end(),
                                         [&](const auto& item) { return item.second == name; });
  return found == state_names.end() ? std::nullopt : std::optional(found->first);
}

CampaignQueue::CampaignQueue(fs::path folder, RobotLibrary& library, const Presence& presence,
                             Listener listener)
    : folder_(std::move(folder)),
      library_(library),
      presence_(presence),
      listener_(std::move(listener)) {
  refresh();
  thread_ = std::thread([this] { work(); });
}

CampaignQueue::~CampaignQueue() {
  stop(std::chrono::milliseconds(0));
  thread_.join();
}

FileLock CampaignQueue::alone() const {
  std::optional<FileLock> lock;
  try {
    fs::create_directories(folder_);
    lock = FileLock::take(folder_ / lock_file, lock_patience);
  } catch (const std::exception& error) {
    throw CommandError(Kind::failed, error.what());
  }
  if (!lock) throw CommandError(Kind::busy, "another server is changing campaigns");
  return std::move(*lock);
}

/// What is told of these is in memory; of all others, in their folders.
bool CampaignQueue::is_ours(const Entry& entry) const {
  return is_active(entry.item.state) && entry.owner == presence_.name();
}

void CampaignQueue::read(Entry& entry) const {
  const Folder folder(path_of(entry.item.id));
  std::string saved = saved_state(folder.path());
  if (saved == entry.saved && !is_active(entry.item.state)) return;
  entry.saved = std::move(saved);
  QueueItem item;
  item.id = entry.item.id;
  try {
    const Json state = Json::parse(entry.saved);
    entry.owner = state.value("owner", "");
    item.state = queue_state_of(state.value("state", "")).value_or(QueueState::interrupted);
    if (is_active(item.state) && !presence_.is_another(entry.owner)) {
      item.state = QueueState::interrupted;
    }
    item.name = state.value("name", "");
    item.error = state.value("error", "");
    item.most = state.value("most", std::uint64_t{0});
    item.bisection = state.value("bisection", false);
    if (state.contains("passed") && state["passed"].is_boolean()) item.passed = state["passed"];
    item.counts = Store(folder.store(), Store::Access::read).counts();
  } catch (const std::exception& bad) {
    item.state = QueueState::failed;
    item.error = bad.what();
  }
  entry.item = std::move(item);
}

void CampaignQueue::refresh() {
  std::set<std::uint64_t> present;
  std::error_code error;
  for (const auto& each : fs::directory_iterator(folder_, error)) {
    const auto id = id_of(each.path());
    if (!id || !Folder(each.path()).holds_campaign()) continue;
    present.insert(*id);
    EntryPtr& entry = entries_[*id];
    if (entry == nullptr) {
      entry = std::make_shared<Entry>();
      entry->item.id = *id;
    }
    if (!is_ours(*entry)) read(*entry);
    last_id_ = std::max(last_id_, *id);
  }
  std::erase_if(entries_, [&](const auto& each) {
    return !present.contains(each.first) && !is_ours(*each.second);
  });
}

CampaignQueue::Entry& CampaignQueue::changeable(std::uint64_t id) {
  refresh();
  Entry& entry = *entry_of(id);
  if (is_active(entry.item.state) && !is_ours(entry)) {
    throw CommandError(Kind::conflict, "another server has the campaign, which is " +
                                           std::string(name_of(entry.item.state)));
  }
  return entry;
}

QueueItem CampaignQueue::add(const std::string& specification) {
  const std::shared_ptr<const Plan> plan = plan_of(specification, library_);
  const auto entry = std::make_shared<Entry>();
  QueueItem item;
  {
    const FileLock alone_now = alone();
    const std::lock_guard lock(mutex_);
    if (stopping_) throw CommandError(Kind::stopping, "the server stops");
    refresh();
    const auto waiting = std::count_if(entries_.begin(), entries_.end(),
                                       [this](const auto& each) { return is_ours(*each.second); });
    if (static_cast<std::size_t>(waiting) >= most_waiting) {
      throw CommandError(Kind::busy, std::to_string(most_waiting) +
                                         " campaigns wait or run already; that is the most");
    }
    if (entries_.size() >= most_kept) {
      throw CommandError(Kind::conflict, std::to_string(most_kept) +
                                             " campaigns are kept, which is the most: delete one");
    }
    const auto now = std::chrono::system_clock::now().time_since_epoch();
    const auto ms = std::chrono::duration_cast<std::chrono::milliseconds>(now).count();
    last_id_ = std::max(static_cast<std::uint64_t>(ms), last_id_ + 1);
    item.id = last_id_;
    item.name = plan->spec().name;
    item.most = plan->design().most_trials();
    item.bisection = plan->design().is_bisection();
    entry->item = item;
    entry->owner = presence_.name();
    try {
      // Once it is there to be seen by others, it says whose it is.
      fs::create_directories(path_of(item.id));
      save(*entry);
      Folder(path_of(item.id)).create(specification);
    } catch (const std::exception& error) {
      throw CommandError(Kind::failed, error.what());
    }
    entry->plan = plan;
    entries_.emplace(item.id, entry);
  }
  changed_.notify_all();
  tell(item);
  return item;
}

CampaignQueue::EntryPtr CampaignQueue::entry_of(std::uint64_t id) const {
  const auto found = entries_.find(id);
  if (found != entries_.end()) return found->second;
  throw CommandError(Kind::not_found, "there is no campaign \"" + std::to_string(id) + "\"");
}

CampaignQueue::EntryPtr CampaignQueue::current(std::uint64_t id) {
  const auto known = entries_.find(id);
  if (known == entries_.end() || !is_ours(*known->second)) refresh();
  return entry_of(id);
}

QueueItem CampaignQueue::find(std::uint64_t id) {
  const std::lock_guard lock(mutex_);
  return current(id)->item;
}

std::vector<QueueItem> CampaignQueue::list(std::uint64_t before, std::size_t limit,
                                           std::optional<QueueState> state) {
  const std::lock_guard lock(mutex_);
  refresh();
  std::vector<QueueItem> items;
  for (auto at = entries_.rbegin(); at != entries_.rend() && items.size() < limit; ++at) {
    const QueueItem& item = at->second->item;
    if (item.id < before && (!state || item.state == *state)) items.push_back(item);
  }
  return items;
}

QueueItem CampaignQueue::cancel(std::uint64_t id) {
  QueueItem item;
  {
    const std::lock_guard lock(mutex_);
    Entry& entry = changeable(id);
    if (!is_active(entry.item.state)) {
      throw CommandError(Kind::conflict,
                         "the campaign is " + std::string(name_of(entry.item.state)) + " already");
    }
    entry.cancel = true;
    entry.item.state =
        entry.item.state == QueueState::queued ? QueueState::cancelled : QueueState::cancelling;
    if (entry.item.state == QueueState::cancelled) entry.plan.reset();
    save(entry);
    item = entry.item;
  }
  tell(item);
  return item;
}

QueueItem CampaignQueue::resume(std::uint64_t id) {
  QueueItem item;
  {
    const FileLock alone_now = alone();
    const std::lock_guard lock(mutex_);
    if (stopping_) throw CommandError(Kind::stopping, "the server stops");
    Entry& entry = changeable(id);
    if (entry.item.state != QueueState::interrupted && entry.item.state != QueueState::cancelled) {
      throw CommandError(Kind::conflict, "the campaign is " +
                                             std::string(name_of(entry.item.state)) +
                                             "; allowed: interrupted, cancelled");
    }
    try {
      const FolderLock probe{Folder(path_of(id))};  // `stagger campaign` may run it
    } catch (const std::exception& error) {
      throw CommandError(Kind::conflict, error.what());
    }
    entry.cancel = false;
    entry.item.state = QueueState::queued;
    entry.item.error.clear();
    entry.owner = presence_.name();
    save(entry);
    item = entry.item;
  }
  changed_.notify_all();
  tell(item);
  return item;
}

void CampaignQueue::remove(std::uint64_t id) {
  const FileLock alone_now = alone();
  const std::lock_guard files(files_mutex_);
  const std::lock_guard lock(mutex_);
  if (is_active(changeable(id).item.state)) {
    throw CommandError(Kind::conflict, "the campaign waits or runs: cancel it first");
  }
  std::error_code error;
  fs::remove_all(path_of(id), error);
  if (error) throw CommandError(Kind::failed, "cannot delete it: " + error.message());
  entries_.erase(id);
}

Results CampaignQueue::results(std::uint64_t id, OutputFile file) {
  const Folder folder(path_of(id));
  std::unique_lock files(files_mutex_);
  std::unique_lock lock(mutex_);
  const EntryPtr entry = current(id);
  const QueueState state = entry->item.state;
  std::shared_ptr<const Plan> plan = entry->plan;
  lock.unlock();
  Results results;
  if (!is_active(state) && fs::exists(folder.path_of(file))) {
    results.file = folder.path_of(file);
  } else {
    try {
      const auto store =
          std::make_shared<const Store>(folder.store(), ResultsReader::access_for(file));
      files.unlock();
      if (plan == nullptr) plan = plan_of(store->specification(), library_);
      results = reader_.read(folder, file, plan, store);
    } catch (const CommandError&) {
      throw;
    } catch (const std::exception& error) {
      throw CommandError(Kind::conflict,
                         std::string("the results cannot be made: ") + error.what());
    }
  }
  results.partial = state != QueueState::done;
  return results;
}

bool CampaignQueue::stop(std::chrono::milliseconds patience) {
  std::unique_lock lock(mutex_);
  stopping_ = true;
  changed_.notify_all();
  return changed_.wait_for(lock, patience, [this] { return idle_; });
}

void CampaignQueue::work() {
  yield_to_others();
  std::unique_lock lock(mutex_);
  while (!stopping_) {
    const auto next = std::find_if(entries_.begin(), entries_.end(), [this](const auto& each) {
      return each.second->item.state == QueueState::queued && is_ours(*each.second);
    });
    if (next == entries_.end()) {
      changed_.wait(lock);
      continue;
    }
    const EntryPtr entry = next->second;
    entry->item.state = QueueState::running;
    lock.unlock();
    try {
      run(*entry);
    } catch (const std::exception& error) {
      finish(*entry, QueueState::failed, error.what());
    }
    lock.lock();
  }
  idle_ = true;
  changed_.notify_all();
}

void CampaignQueue::run(Entry& entry) {
  // Its lock is let go of before anybody reads that it has ended, and goes on with it.
  const End end = run_trials(entry);
  if (end == End::mismatch) {
    finish(entry, QueueState::failed, "a trial that was run twice did not repeat to the bit");
  } else if (end == End::stopped) {
    finish(entry, entry.cancel ? QueueState::cancelled : QueueState::interrupted, "");
  } else {
    finish(entry, QueueState::done,
           end == End::aborted ? "a threshold failed that ends the campaign" : "");
  }
}

End CampaignQueue::run_trials(Entry& entry) {
  const std::uint64_t id = entry.item.id;
  tell(find(id));
  const Folder folder(path_of(id));
  const FolderLock folder_lock(folder);
  {
    const std::lock_guard lock(mutex_);
    save(entry);
  }
  Store store(folder.store(), Store::Access::write);
  const std::shared_ptr<const Plan> plan = plan_of(store.specification(), library_);
  {
    const std::lock_guard lock(mutex_);
    entry.plan = plan;
  }
  require_unchanged(*plan, store);
  folder.remove_files();  // of an earlier end, in case that this process does not get to write them

  const Clock::time_point start = Clock::now();
  const std::uint64_t before = store.count();
  Clock::time_point next_telling = start;
  CampaignOptions options;
  options.runner.threads = worker_threads();
  options.runner.stop = [&] { return stopping_ || entry.cancel; };
  options.watch = [&](const Record&, const Progress& progress) {
    const Clock::time_point now = Clock::now();
    const double elapsed = std::chrono::duration<double>(now - start).count();
    const auto fresh = static_cast<double>(progress.counts.trials - before);
    const auto left =
        static_cast<double>(progress.most - std::min(progress.most, progress.counts.trials));
    QueueItem item;
    {
      const std::lock_guard lock(mutex_);
      entry.item.counts = progress.counts;
      entry.item.eta_s = elapsed / std::max(fresh, 1.0) * left;
      item = entry.item;
    }
    if (now < next_telling) return;
    next_telling = now + telling_period;
    tell(item);
  };
  const End end = run_campaign(*plan, store, options);
  const Summary summary = summarize(*plan, store);
  folder.write_files(*plan, store, summary);
  const std::lock_guard lock(mutex_);
  entry.item.counts = summary.counts;
  if (end == End::complete || end == End::aborted) {
    entry.item.passed =
        end == End::complete && summary.thresholds_passed() && summary.counts.invalid == 0;
  }
  return end;
}

void CampaignQueue::finish(Entry& entry, QueueState state, const std::string& error) {
  QueueItem item;
  {
    const std::lock_guard lock(mutex_);
    entry.item.state = state;
    entry.item.error = error;
    entry.item.eta_s.reset();
    entry.plan.reset();
    try {
      save(entry);
    } catch (const std::exception& bad) {
      entry.item.error = bad.what();  // it is told, if it cannot be kept
    }
    item = entry.item;
  }
  tell(item);
}

void CampaignQueue::tell(const QueueItem& item) const {
  if (listener_) listener_(item);
}

void CampaignQueue::save(Entry& entry) const {
  const QueueItem& item = entry.item;
  const std::string state = to_text({{"name", item.name},
                                     {"state", name_of(item.state)},
                                     {"owner", is_active(item.state) ? entry.owner : ""},
                                     {"most", item.most},
                                     {"bisection", item.bisection},
                                     {"passed", or_null(item.passed)},
                                     {"error", item.error}}) +
                            '\n';
  const fs::path file = path_of(item.id) / state_file;
  const fs::path unfinished = file.string() + ".part";
  {
    std::ofstream out(unfinished);
    out << state;
    out.close();
    if (!out) throw std::runtime_error("cannot write " + file.string());
  }
  fs::rename(unfinished, file);
  entry.saved = state;
}

}  // namespace stagger::server::campaign
