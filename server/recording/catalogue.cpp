#include "server/recording/catalogue.h"

#include <spdlog/spdlog.h>
#include <sqlite3.h>

#include <stdexcept>
#include <utility>

#include "server/json/json.h"

namespace stagger::server {
namespace {

constexpr int busy_patience_ms = 5000;

constexpr const char* tables = R"(
  PRAGMA journal_mode = WAL;
  PRAGMA synchronous = NORMAL;
  CREATE TABLE IF NOT EXISTS recordings (
    id TEXT PRIMARY KEY, state TEXT NOT NULL, reason TEXT NOT NULL, created_s REAL NOT NULL,
    robot TEXT NOT NULL, plant TEXT NOT NULL, seed INTEGER NOT NULL, session_id TEXT NOT NULL,
    version TEXT NOT NULL, worlds INTEGER NOT NULL, ticks INTEGER NOT NULL,
    lost_ticks INTEGER NOT NULL, pushes INTEGER NOT NULL, falls INTEGER NOT NULL,
    bytes INTEGER NOT NULL, error TEXT NOT NULL,
    note TEXT NOT NULL, tags TEXT NOT NULL, protected INTEGER NOT NULL,
    owner TEXT NOT NULL DEFAULT ''
  ) WITHOUT ROWID;)";
// Catalogues of before several servers could tell their recordings apart.
constexpr const char* has_owner_sql =
    "SELECT 1 FROM pragma_table_info('recordings') WHERE name='owner'";
constexpr const char* add_owner_sql =
    "ALTER TABLE recordings ADD COLUMN owner TEXT NOT NULL DEFAULT ''";

// Parameters have one order everywhere: ?1 is the id.
constexpr const char* put_sql =
    "INSERT OR REPLACE INTO recordings VALUES"
    "(?1,?2,?3,?4,?5,?6,?7,?8,?9,?10,?11,?12,?13,?14,?15,?16,?17,?18,?19,?20)";
constexpr const char* update_sql =
    "UPDATE recordings SET state=?2, reason=?3, created_s=?4, robot=?5, plant=?6, seed=?7,"
    " session_id=?8, version=?9, worlds=?10, ticks=?11, lost_ticks=?12, pushes=?13, falls=?14,"
    " bytes=?15, error=?16 WHERE id=?1";
constexpr const char* annotate_sql =
    "UPDATE recordings SET note=?17, tags=?18, protected=?19 WHERE id=?1";

std::string tags_text(const std::vector<std::string>& tags) { return to_text(Json(tags)); }

std::vector<std::string> tags_of(const std::string& text) {
  const Json json = Json::parse(text, nullptr, false);
  std::vector<std::string> tags;
  if (!json.is_array()) return tags;
  for (const Json& tag : json) {
    if (tag.is_string()) tags.push_back(tag.get<std::string>());
  }
  return tags;
}

}  // namespace

struct Catalogue::Database {
  sqlite3* handle = nullptr;
};

/// One statement: bind, step, read.
struct Catalogue::Statement {
  Statement(sqlite3* database, const char* sql) : database_(database) {
    if (sqlite3_prepare_v2(database, sql, -1, &statement_, nullptr) != SQLITE_OK) fail();
  }
  Statement(const Statement&) = delete;
  Statement& operator=(const Statement&) = delete;
  ~Statement() { sqlite3_finalize(statement_); }

  void bind(int at, const std::string& text) {
    sqlite3_bind_text(statement_, at, text.data(), static_cast<int>(text.size()), SQLITE_TRANSIENT);
  }
  void bind(int at, std::string_view text) { bind(at, std::string(text)); }
  void bind(int at, std::uint64_t number) {
    sqlite3_bind_int64(statement_, at, static_cast<sqlite3_int64>(number));
  }
  void bind(int at, double number) { sqlite3_bind_double(statement_, at, number); }

  /// Is there a row?
  bool step() {
    const int result = sqlite3_step(statement_);
    if (result != SQLITE_ROW && result != SQLITE_DONE) fail();
    return result == SQLITE_ROW;
  }

  std::string text(int column) {
    const auto* bytes = sqlite3_column_text(statement_, column);
    const auto size = static_cast<std::size_t>(sqlite3_column_bytes(statement_, column));
    return bytes == nullptr ? "" : std::string(reinterpret_cast<const char*>(bytes), size);
  }
  std::uint64_t number(int column) {
    return static_cast<std::uint64_t>(sqlite3_column_int64(statement_, column));
  }
  double real(int column) { return sqlite3_column_double(statement_, column); }

  RecordingInfo info() {
    RecordingInfo info;
    info.id = text(0);
    info.state = recording_state_of(text(1)).value_or(RecordingState::done);
    info.reason = recording_reason_of(text(2)).value_or(RecordingReason::manual);
    info.created_s = real(3);
    info.robot = text(4);
    info.plant = text(5);
    info.seed = number(6);
    info.session_id = text(7);
    info.version = text(8);
    info.worlds = number(9);
    info.ticks = number(10);
    info.lost_ticks = number(11);
    info.pushes = number(12);
    info.falls = number(13);
    info.bytes = number(14);
    info.error = text(15);
    info.note = text(16);
    info.tags = tags_of(text(17));
    info.is_protected = number(18) != 0;
    info.owner = text(19);
    return info;
  }

 private:
  [[noreturn]] void fail() const {
    throw std::runtime_error(std::string("the catalogue of recordings: ") +
                             sqlite3_errmsg(database_));
  }

  sqlite3* database_;
  sqlite3_stmt* statement_ = nullptr;
};

Catalogue::Catalogue(const std::filesystem::path& file) : database_(std::make_unique<Database>()) {
  try {
    open(file);
    return;
  } catch (const std::runtime_error& error) {
    // It is not broken: another server writes it, for longer than anybody waits.
    if (sqlite3_errcode(database_->handle) == SQLITE_BUSY) {
      close();
      throw;
    }
    spdlog::warn("{}; it is set aside, and begun anew from the files", error.what());
  }
  close();
  std::error_code ignored;
  std::filesystem::rename(file, file.string() + ".broken", ignored);
  for (const char* ending : {"-wal", "-shm"}) {
    std::filesystem::remove(file.string() + ending, ignored);
  }
  open(file);
}

Catalogue::~Catalogue() { close(); }

void Catalogue::open(const std::filesystem::path& file) {
  if (sqlite3_open(file.c_str(), &database_->handle) != SQLITE_OK) {
    throw std::runtime_error("the catalogue of recordings cannot be opened: " + file.string());
  }
  sqlite3_busy_timeout(database_->handle, busy_patience_ms);
  execute(tables);
  if (!Statement(database_->handle, has_owner_sql).step()) execute(add_owner_sql);
  Statement check(database_->handle, "PRAGMA quick_check(1)");
  if (!check.step() || check.text(0) != "ok") {
    throw std::runtime_error("the catalogue of recordings is broken: " + file.string());
  }
  Statement columns(database_->handle, "SELECT * FROM recordings LIMIT 1");
  if (columns.step()) columns.info();
}

void Catalogue::close() { sqlite3_close(std::exchange(database_->handle, nullptr)); }

void Catalogue::execute(const char* sql) const {
  if (sqlite3_exec(database_->handle, sql, nullptr, nullptr, nullptr) != SQLITE_OK) {
    throw std::runtime_error(std::string("the catalogue of recordings: ") +
                             sqlite3_errmsg(database_->handle));
  }
}

void Catalogue::alone(const std::function<void()>& change) const {
  execute("BEGIN IMMEDIATE");
  try {
    change();
    execute("COMMIT");
  } catch (const std::exception&) {
    sqlite3_exec(database_->handle, "ROLLBACK", nullptr, nullptr, nullptr);
    throw;
  }
}

void Catalogue::write(const char* sql, const RecordingInfo& info) const {
  Statement statement(database_->handle, sql);
  statement.bind(1, info.id);
  statement.bind(2, name_of(info.state));
  statement.bind(3, name_of(info.reason));
  statement.bind(4, info.created_s);
  statement.bind(5, info.robot);
  statement.bind(6, info.plant);
  statement.bind(7, info.seed);
  statement.bind(8, info.session_id);
  statement.bind(9, info.version);
  statement.bind(10, info.worlds);
  statement.bind(11, info.ticks);
  statement.bind(12, info.lost_ticks);
  statement.bind(13, info.pushes);
  statement.bind(14, info.falls);
  statement.bind(15, info.bytes);
  statement.bind(16, info.error);
  statement.bind(17, info.note);
  statement.bind(18, tags_text(info.tags));
  statement.bind(19, std::uint64_t{info.is_protected ? 1U : 0U});
  statement.bind(20, info.owner);
  statement.step();
}

void Catalogue::put(const RecordingInfo& info) {
  const std::lock_guard lock(mutex_);
  write(put_sql, info);
}

void Catalogue::put(const RecordingInfo& info, const std::filesystem::path& file) {
  const std::lock_guard lock(mutex_);
  alone([&] {
    if (std::filesystem::exists(file)) write(put_sql, info);
  });
}

void Catalogue::update(const RecordingInfo& info) {
  const std::lock_guard lock(mutex_);
  write(update_sql, info);
}

void Catalogue::annotate(const RecordingInfo& info) {
  const std::lock_guard lock(mutex_);
  write(annotate_sql, info);
}

void Catalogue::remove(const std::string& id) {
  const std::lock_guard lock(mutex_);
  Statement statement(database_->handle, "DELETE FROM recordings WHERE id=?1");
  statement.bind(1, id);
  statement.step();
}

bool Catalogue::remove_done(const std::string& id, const std::filesystem::path& file) {
  const std::lock_guard lock(mutex_);
  bool removed = false;
  alone([&] {
    Statement statement(database_->handle,
                        "DELETE FROM recordings WHERE id=?1 AND state='done' AND protected=0");
    statement.bind(1, id);
    statement.step();
    removed = sqlite3_changes(database_->handle) > 0;
    std::error_code ignored;
    if (removed) std::filesystem::remove(file, ignored);
  });
  return removed;
}

std::optional<RecordingInfo> Catalogue::find(const std::string& id) const {
  const std::lock_guard lock(mutex_);
  Statement statement(database_->handle, "SELECT * FROM recordings WHERE id=?1");
  statement.bind(1, id);
  if (!statement.step()) return std::nullopt;
  return statement.info();
}

std::vector<RecordingInfo> Catalogue::list(const CatalogueQuery& query) const {
  const std::lock_guard lock(mutex_);
  Statement statement(
      database_->handle,
      "SELECT * FROM recordings WHERE (?1='' OR id<?1) AND (?2='' OR state=?2)"
      " AND (?3='' OR reason=?3)"
      " AND (?4='' OR EXISTS (SELECT 1 FROM json_each(tags) WHERE json_each.value=?4))"
      " ORDER BY id DESC LIMIT ?5");
  statement.bind(1, query.before);
  statement.bind(2, query.state ? name_of(*query.state) : "");
  statement.bind(3, query.reason ? name_of(*query.reason) : "");
  statement.bind(4, query.tag.value_or(""));
  statement.bind(5, static_cast<std::uint64_t>(query.limit));
  std::vector<RecordingInfo> result;
  while (statement.step()) result.push_back(statement.info());
  return result;
}

std::uint64_t Catalogue::bytes() const {
  const std::lock_guard lock(mutex_);
  Statement statement(database_->handle, "SELECT COALESCE(SUM(bytes), 0) FROM recordings");
  return statement.step() ? statement.number(0) : 0;
}

std::optional<RecordingInfo> Catalogue::oldest_removable(
    std::optional<RecordingReason> reason) const {
  const std::lock_guard lock(mutex_);
  Statement statement(database_->handle,
                      "SELECT * FROM recordings WHERE state='done' AND protected=0"
                      " AND (?1='' OR reason=?1) ORDER BY id LIMIT 1");
  statement.bind(1, reason ? name_of(*reason) : "");
  if (!statement.step()) return std::nullopt;
  return statement.info();
}

std::uint64_t Catalogue::count_removable(RecordingReason reason) const {
  const std::lock_guard lock(mutex_);
  Statement statement(
      database_->handle,
      "SELECT COUNT(*) FROM recordings WHERE state='done' AND protected=0 AND reason=?1");
  statement.bind(1, name_of(reason));
  return statement.step() ? statement.number(0) : 0;
}

}  // namespace stagger::server
