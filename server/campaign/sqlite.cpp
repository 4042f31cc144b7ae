#include "server/campaign/sqlite.h"

#include <sqlite3.h>

namespace stagger::server::campaign {
namespace {

/// Another process, `stagger campaign status`, may read while this one writes [ms].
constexpr int busy_timeout_ms = 30'000;

}  // namespace

void Statement::Finalize::operator()(sqlite3_stmt* statement) const { sqlite3_finalize(statement); }

Statement::Statement(sqlite3* database, std::string_view sql) : database_(database) {
  sqlite3_stmt* made = nullptr;
  const int code =
      sqlite3_prepare_v2(database, sql.data(), static_cast<int>(sql.size()), &made, nullptr);
  statement_.reset(made);
  if (code != SQLITE_OK) fail();
}

void Statement::fail() const { throw SqliteError(sqlite3_errmsg(database_)); }

void Statement::bind(int at, std::int64_t value) {
  if (sqlite3_bind_int64(statement_.get(), at + 1, value) != SQLITE_OK) fail();
}
void Statement::bind(int at, double value) {
  if (sqlite3_bind_double(statement_.get(), at + 1, value) != SQLITE_OK) fail();
}
void Statement::bind(int at, std::string_view value) {
  if (sqlite3_bind_text(statement_.get(), at + 1, value.data(), static_cast<int>(value.size()),
                        SQLITE_TRANSIENT) != SQLITE_OK) {
    fail();
  }
}
void Statement::bind_null(int at) {
  if (sqlite3_bind_null(statement_.get(), at + 1) != SQLITE_OK) fail();
}

bool Statement::step() {
  const int code = sqlite3_step(statement_.get());
  if (code == SQLITE_ROW) return true;
  if (code != SQLITE_DONE) fail();
  return false;
}

void Statement::run() {
  while (step()) {
  }
  reset();
}

void Statement::reset() { sqlite3_reset(statement_.get()); }

bool Statement::is_null(int column) const {
  return sqlite3_column_type(statement_.get(), column) == SQLITE_NULL;
}
std::int64_t Statement::integer(int column) const {
  return sqlite3_column_int64(statement_.get(), column);
}
double Statement::number(int column) const {
  return sqlite3_column_double(statement_.get(), column);
}
std::string Statement::text(int column) const {
  const unsigned char* text = sqlite3_column_text(statement_.get(), column);
  const auto size = static_cast<std::size_t>(sqlite3_column_bytes(statement_.get(), column));
  return text == nullptr ? std::string() : std::string(text, text + size);
}

void Database::Close::operator()(sqlite3* database) const { sqlite3_close_v2(database); }

Database::Database(const std::filesystem::path& file, Access access) {
  int flags = SQLITE_OPEN_NOMUTEX | SQLITE_OPEN_READWRITE;
  if (access == Access::create) flags |= SQLITE_OPEN_CREATE;
  if (access == Access::read) flags = SQLITE_OPEN_NOMUTEX | SQLITE_OPEN_READONLY;
  sqlite3* opened = nullptr;
  const int code = sqlite3_open_v2(file.c_str(), &opened, flags, nullptr);
  database_.reset(opened);
  if (code != SQLITE_OK) throw SqliteError(file.string() + ": " + sqlite3_errstr(code));
  sqlite3_busy_timeout(opened, busy_timeout_ms);
}

void Database::run(const std::string& sql) {
  if (sqlite3_exec(database_.get(), sql.c_str(), nullptr, nullptr, nullptr) != SQLITE_OK) {
    throw SqliteError(sqlite3_errmsg(database_.get()));
  }
}

}  // namespace stagger::server::campaign
