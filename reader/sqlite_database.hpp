#pragma once

#include <cstddef>
#include <cstdint>
#include <memory>
#include <span>
#include <string>
#include <string_view>

#include "hal/error.hpp"
#include "hal/time.hpp"

struct sqlite3;
struct sqlite3_stmt;

namespace forager::reader {

// A prepared statement. Parameters and columns count from 0. A failed bind shows at step().
class SqliteStatement {
 public:
  SqliteStatement() = default;
  explicit SqliteStatement(sqlite3_stmt* statement) : statement_(statement) {}

  void bind(int parameter, std::int64_t value);
  void bind(int parameter, double value);
  // Text and blobs are borrowed: they must outlive the next reset().
  void bind(int parameter, std::string_view text);
  void bind(int parameter, std::span<const std::uint8_t> blob);
  void bind_null(int parameter);

  // SQLITE_ROW, SQLITE_DONE or an error code of SQLite.
  int step();
  void reset();
  // step() to the end and reset(); SQLITE_OK or an error code.
  int run();

  [[nodiscard]] std::int64_t integer(int column) const;
  [[nodiscard]] double real(int column) const;
  [[nodiscard]] std::string text(int column) const;
  [[nodiscard]] std::span<const std::uint8_t> blob(int column) const;
  [[nodiscard]] bool is_null(int column) const;

 private:
  struct Finalize {
    void operator()(sqlite3_stmt* statement) const;
  };
  std::unique_ptr<sqlite3_stmt, Finalize> statement_;
};

enum class SqliteAccess : std::uint8_t { read, write, create };

// One connection, with SQLite's result codes turned into errors a person can act on.
class SqliteDatabase {
 public:
  // Errors: not_present, permission, busy, protocol (not a database), io.
  [[nodiscard]] static hal::Result<SqliteDatabase> open(const std::string& path, SqliteAccess access,
                                                        hal::Duration busy_wait);

  // The error of a result code, with the operation that met it.
  [[nodiscard]] hal::Failure failure(int code, std::string operation) const;
  [[nodiscard]] hal::Result<> execute(const std::string& sql, const std::string& operation) const;
  // The statement is for many uses. sql is our own and right, so this fails only for a damaged file.
  [[nodiscard]] hal::Result<SqliteStatement> prepare(std::string_view sql) const;
  // First column of the first row.
  [[nodiscard]] hal::Result<std::int64_t> query_integer(std::string_view sql) const;

  [[nodiscard]] const std::string& name() const { return name_; }

 private:
  struct Close {
    void operator()(sqlite3* connection) const;
  };
  std::string name_;
  std::unique_ptr<sqlite3, Close> connection_;
};

}  // namespace forager::reader
