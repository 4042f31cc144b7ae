#include "server/campaign/store.h"

#include <array>
#include <charconv>

#include "sim/state_hash.h"

namespace stagger::server::campaign {
namespace {

constexpr const char* format = "stagger campaign 1";

constexpr const char* tables = R"(
  CREATE TABLE campaign(key TEXT PRIMARY KEY, value TEXT NOT NULL) WITHOUT ROWID;
  CREATE TABLE trials(
    number INTEGER PRIMARY KEY,
    id TEXT NOT NULL,
    seed INTEGER NOT NULL,
    repeat INTEGER NOT NULL,
    "values" TEXT NOT NULL,
    impulse_ns REAL NOT NULL,
    force_n REAL NOT NULL,
    delta_v REAL NOT NULL,
    fr REAL NOT NULL,
    ceiling_dv REAL,
    outcome INTEGER NOT NULL,
    reason TEXT NOT NULL,
    passed INTEGER NOT NULL,
    delivered_ns REAL NOT NULL,
    push_tick INTEGER,
    steps_to_recover INTEGER,
    recovery_time_s REAL,
    fall_time_s REAL,
    worst_dcm_error_m REAL NOT NULL,
    ticks INTEGER NOT NULL,
    state_hash INTEGER NOT NULL,
    repeated INTEGER,
    cpu_s REAL NOT NULL);
)";
constexpr const char* columns =
    "number, id, seed, repeat, \"values\", impulse_ns, force_n, delta_v, fr, ceiling_dv, outcome, "
    "reason, passed, delivered_ns, push_tick, steps_to_recover, recovery_time_s, fall_time_s, "
    "worst_dcm_error_m, ticks, state_hash, repeated, cpu_s";

std::optional<std::int64_t> as_signed(const std::optional<std::uint64_t>& value) {
  return value ? std::optional(static_cast<std::int64_t>(*value)) : std::nullopt;
}

}  // namespace

void Store::create(const std::filesystem::path& file, const std::string& specification,
                   Journal journal) {
  if (std::filesystem::exists(file)) throw SqliteError(file.string() + ": is there already");
  Database database(file, Database::Access::create);
  // The rollback journal is what SQLite does by itself.
  if (journal == Journal::wal) database.run("PRAGMA journal_mode=WAL");
  database.run("BEGIN");
  database.run(tables);
  Statement insert = database.prepare("INSERT INTO campaign VALUES(?, ?)");
  for (const auto& [key, value] :
       {std::pair{"format", std::string(format)}, std::pair{"specification", specification},
        std::pair{"version", std::string(STAGGER_VERSION)}}) {
    insert.bind(0, std::string_view(key));
    insert.bind(1, std::string_view(value));
    insert.run();
  }
  database.run("COMMIT");
}

Store::Store(const std::filesystem::path& file, Access access)
    : file_(file),
      database_(file, access == Access::write ? Database::Access::write : Database::Access::read) {
  const auto value = [&](const char* key) {
    Statement select = database_.prepare("SELECT value FROM campaign WHERE key = ?");
    select.bind(0, std::string_view(key));
    return select.step() ? select.text(0) : std::string();
  };
  try {
    // What has been committed outlives the process with NORMAL too, and a commit waits for no disk.
    if (access == Access::write) database_.run("PRAGMA synchronous=NORMAL");
    // The transaction begins with what is read next and ends with the connection.
    if (access == Access::snapshot) database_.run("BEGIN");
    if (value("format") != format) throw SqliteError("is of another format");
    specification_ = value("specification");
    version_ = value("version");
    const std::string names(columns);
    insert_.emplace(database_.prepare("INSERT OR IGNORE INTO trials(" + names +
                                      ") VALUES(?,?,?,?,?,?,?,?,?,?,?,?,?,?,?,?,?,?,?,?,?,?,?) "
                                      "RETURNING number"));
    find_.emplace(database_.prepare("SELECT " + names + " FROM trials WHERE number = ?"));
    page_.emplace(database_.prepare("SELECT " + names +
                                    " FROM trials WHERE number >= ? ORDER BY number LIMIT ?"));
  } catch (const SqliteError& error) {
    throw SqliteError(file.string() + ": is no store of a campaign: " + error.what());
  }
  for_each([this](const Record& record) { count_in(record); });
}

void Store::count_in(const Record& record) {
  ++counts_.trials;
  switch (record.result.outcome) {
    case sim::TrialOutcome::recovered:
      ++counts_.recovered;
      break;
    case sim::TrialOutcome::fell:
      ++counts_.fell;
      break;
    case sim::TrialOutcome::timeout:
      ++counts_.timeout;
      break;
    case sim::TrialOutcome::invalid:
      ++counts_.invalid;
      break;
  }
  if (record.passed) ++counts_.passed;
  if (record.repeated) ++counts_.twice;
  if (record.repeated == false) ++counts_.mismatches;
}

bool Store::put(const Record& record) {
  const sim::TrialResult& r = record.result;
  const auto integer = [](auto value) { return static_cast<std::int64_t>(value); };
  const std::lock_guard lock(mutex_);
  Statement& s = *insert_;
  int at = 0;
  s.bind(at++, integer(record.number));
  s.bind(at++, std::string_view(record.id));
  s.bind(at++, integer(record.seed));
  s.bind(at++, integer(record.repeat));
  s.bind(at++, std::string_view(record.values));
  s.bind(at++, record.push.impulse_ns);
  s.bind(at++, record.push.force_n);
  s.bind(at++, record.push.delta_v);
  s.bind(at++, record.push.fr);
  s.bind(at++, record.ceiling_dv);
  s.bind(at++, integer(r.outcome));
  s.bind(at++, std::string_view(r.reason));
  s.bind(at++, integer(record.passed));
  s.bind(at++, r.delivered_ns);
  s.bind(at++, as_signed(r.push_tick));
  s.bind(at++, as_signed(r.steps_to_recover));
  s.bind(at++, r.recovery_time_s);
  s.bind(at++, r.fall_time_s);
  s.bind(at++, r.worst_dcm_error_m);
  s.bind(at++, integer(r.ticks));
  s.bind(at++, integer(r.state_hash));
  s.bind(at++, record.repeated ? std::optional(integer(*record.repeated)) : std::nullopt);
  s.bind(at++, record.cpu_s);
  const bool added = s.step();
  s.run();
  if (added) count_in(record);
  return added;
}

Record Store::row(const Statement& s) {
  const auto number = [&](int column) { return static_cast<std::uint64_t>(s.integer(column)); };
  const auto maybe_number = [&](int column) {
    return s.is_null(column) ? std::nullopt : std::optional(number(column));
  };
  const auto maybe_real = [&](int column) {
    return s.is_null(column) ? std::nullopt : std::optional(s.number(column));
  };
  Record record;
  sim::TrialResult& r = record.result;
  int at = 0;
  record.number = number(at++);
  record.id = s.text(at++);
  record.seed = number(at++);
  record.repeat = number(at++);
  record.values = s.text(at++);
  record.push.impulse_ns = s.number(at++);
  record.push.force_n = s.number(at++);
  record.push.delta_v = s.number(at++);
  record.push.fr = s.number(at++);
  record.ceiling_dv = maybe_real(at++);
  r.outcome = static_cast<sim::TrialOutcome>(s.integer(at++));
  r.reason = s.text(at++);
  record.passed = s.integer(at++) != 0;
  r.delivered_ns = s.number(at++);
  r.push_tick = maybe_number(at++);
  r.steps_to_recover = maybe_number(at++);
  r.recovery_time_s = maybe_real(at++);
  r.fall_time_s = maybe_real(at++);
  r.worst_dcm_error_m = s.number(at++);
  r.ticks = number(at++);
  r.state_hash = number(at++);
  if (!s.is_null(at)) record.repeated = s.integer(at) != 0;
  ++at;
  record.cpu_s = s.number(at++);
  return record;
}

std::uint64_t Store::count() const { return counts().trials; }

Counts Store::counts() const {
  const std::lock_guard lock(mutex_);
  return counts_;
}

std::optional<Record> Store::find(std::uint64_t number) const {
  const std::lock_guard lock(mutex_);
  find_->bind(0, static_cast<std::int64_t>(number));
  std::optional<Record> record;
  if (find_->step()) record = row(*find_);
  find_->reset();
  return record;
}

std::optional<Verdict> Store::verdict(std::uint64_t number) const {
  const auto record = find(number);
  return record ? std::optional(verdict_of(*record)) : std::nullopt;
}

std::vector<Record> Store::page(std::uint64_t from) const {
  std::vector<Record> records;
  const std::lock_guard lock(mutex_);
  page_->bind(0, static_cast<std::int64_t>(from));
  page_->bind(1, static_cast<std::int64_t>(page_size));
  while (page_->step()) records.push_back(row(*page_));
  page_->reset();
  return records;
}

void Store::for_each(const std::function<void(const Record&)>& visit) const {
  std::vector<Record> records = page(0);
  while (!records.empty()) {
    for (const Record& record : records) visit(record);
    records = page(records.back().number + 1);
  }
}

void Store::merge(const Store& other) {
  if (other.specification_ != specification_ || other.version_ != version_) {
    throw std::runtime_error(other.file_.string() + ": is of another campaign than " +
                             file_.string());
  }
  // One transaction: it is quicker, and a merge that fails changes nothing.
  const auto transaction = [this](const char* sql) {
    const std::lock_guard lock(mutex_);
    database_.run(sql);
  };
  const Counts before = counts();
  transaction("BEGIN");
  try {
    other.for_each([&](const Record& record) {
      if (put(record)) return;
      const auto mine = find(record.number);
      if (mine && hash_of(*mine) == hash_of(record)) return;
      throw std::runtime_error(other.file_.string() + ": trial " + std::to_string(record.number) +
                               " has another result than in " + file_.string());
    });
    transaction("COMMIT");
  } catch (...) {
    transaction("ROLLBACK");
    const std::lock_guard lock(mutex_);
    counts_ = before;
    throw;
  }
}

std::uint64_t results_hash(const Store& store) {
  sim::StateHash hash;
  store.for_each([&hash](const Record& record) { hash.mix(hash_of(record)); });
  return hash.value();
}

}  // namespace stagger::server::campaign
