// The little of SQLite that a campaign's store needs.
#pragma once

#include <cstdint>
#include <filesystem>
#include <memory>
#include <optional>
#include <stdexcept>
#include <string>
#include <string_view>

struct sqlite3;
struct sqlite3_stmt;

namespace stagger::server::campaign {

class SqliteError : public std::runtime_error {
 public:
  using std::runtime_error::runtime_error;
};

/// A prepared statement. Parameters and columns count from 0. Throws SqliteError.
class Statement {
 public:
  Statement(sqlite3* database, std::string_view sql);

  void bind(int at, std::int64_t value);
  void bind(int at, double value);
  void bind(int at, std::string_view value);  ///< the text is copied
  void bind_null(int at);
  template <typename T>
  void bind(int at, const std::optional<T>& value) {
    if (value) {
      bind(at, *value);
    } else {
      bind_null(at);
    }
  }

  /// Goes to the next row; false when there is none.
  bool step();
  /// Runs a statement that has no rows, ready to be bound and run again.
  void run();
  void reset();

  bool is_null(int column) const;
  std::int64_t integer(int column) const;
  double number(int column) const;
  std::string text(int column) const;

 private:
  struct Finalize {
    void operator()(sqlite3_stmt* statement) const;
  };
  [[noreturn]] void fail() const;

  sqlite3* database_;
  std::unique_ptr<sqlite3_stmt, Finalize> statement_;
};

/// One connection. Not for two threads at a time.
class Database {
 public:
  enum class Access : std::uint8_t { create, write, read };
  Database(const std::filesystem::path& file, Access access);

  void run(const std::string& sql);
  Statement prepare(std::string_view sql) { return {database_.get(), sql}; }

 private:
  struct Close {
    void operator()(sqlite3* database) const;
  };
  std::unique_ptr<sqlite3, Close> database_;
};

}  // namespace stagger::server::campaign
