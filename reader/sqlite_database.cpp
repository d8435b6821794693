#include "reader/sqlite_database.hpp"

#include <sqlite3.h>

#include <cerrno>
#include <chrono>
#include <utility>

namespace forager::reader {
namespace {

hal::ErrorCode portable(int code, int system_errno) {
  switch (code & 0xFF) {
    case SQLITE_BUSY:
    case SQLITE_LOCKED:
      return hal::ErrorCode::busy;
    case SQLITE_PERM:
    case SQLITE_AUTH:
      return hal::ErrorCode::permission;
    case SQLITE_NOTADB:
    case SQLITE_CORRUPT:
    case SQLITE_SCHEMA:
      return hal::ErrorCode::protocol;
    case SQLITE_CANTOPEN:
      return system_errno == EACCES || system_errno == EPERM || system_errno == EROFS
                 ? hal::ErrorCode::permission
                 : hal::ErrorCode::not_present;
    default:
      return hal::ErrorCode::io;
  }
}

std::string mend_for(int code) {
  switch (code & 0xFF) {
    case SQLITE_BUSY:
      return "Another program is writing to it; try again when it is done";
    case SQLITE_FULL:
      return "Free some space on the disk";
    case SQLITE_NOTADB:
      return "Name a file that forager wrote";
    case SQLITE_CANTOPEN:
      return "Check the path and the rights to its folder";
    default:
      return {};
  }
}

}  // namespace

void SqliteStatement::Finalize::operator()(sqlite3_stmt* statement) const { sqlite3_finalize(statement); }

void SqliteStatement::bind(int parameter, std::int64_t value) {
  sqlite3_bind_int64(statement_.get(), parameter + 1, value);
}
void SqliteStatement::bind(int parameter, double value) {
  sqlite3_bind_double(statement_.get(), parameter + 1, value);
}
void SqliteStatement::bind(int parameter, std::string_view text) {
  sqlite3_bind_text64(statement_.get(), parameter + 1, text.data(), text.size(), SQLITE_STATIC, SQLITE_UTF8);
}
void SqliteStatement::bind(int parameter, std::span<const std::uint8_t> blob) {
  sqlite3_bind_blob64(statement_.get(), parameter + 1, blob.data(), blob.size(), SQLITE_STATIC);
}
void SqliteStatement::bind_null(int parameter) { sqlite3_bind_null(statement_.get(), parameter + 1); }

int SqliteStatement::step() { return sqlite3_step(statement_.get()); }
void SqliteStatement::reset() { sqlite3_reset(statement_.get()); }
int SqliteStatement::run() {
  int code = SQLITE_ROW;
  while (code == SQLITE_ROW) code = step();
  reset();
  return code == SQLITE_DONE ? SQLITE_OK : code;
}

std::int64_t SqliteStatement::integer(int column) const {
  return sqlite3_column_int64(statement_.get(), column);
}
double SqliteStatement::real(int column) const { return sqlite3_column_double(statement_.get(), column); }
std::string SqliteStatement::text(int column) const {
  const auto bytes = blob(column);
  return {bytes.begin(), bytes.end()};
}
std::span<const std::uint8_t> SqliteStatement::blob(int column) const {
  const auto* data = static_cast<const std::uint8_t*>(sqlite3_column_blob(statement_.get(), column));
  const int size = sqlite3_column_bytes(statement_.get(), column);
  return {data, data == nullptr ? 0 : static_cast<std::size_t>(size)};
}
bool SqliteStatement::is_null(int column) const {
  return sqlite3_column_type(statement_.get(), column) == SQLITE_NULL;
}

void SqliteDatabase::Close::operator()(sqlite3* connection) const { sqlite3_close_v2(connection); }

hal::Result<SqliteDatabase> SqliteDatabase::open(const std::string& path, SqliteAccess access,
                                                 hal::Duration busy_wait) {
  SqliteDatabase database;
  database.name_ = "inventory " + path;
  int flags = SQLITE_OPEN_READWRITE | SQLITE_OPEN_NOMUTEX;
  if (access == SqliteAccess::create) flags |= SQLITE_OPEN_CREATE;
  if (access == SqliteAccess::read) flags = SQLITE_OPEN_READONLY | SQLITE_OPEN_NOMUTEX;
  sqlite3* connection = nullptr;
  const int code = sqlite3_open_v2(path.c_str(), &connection, flags, nullptr);
  database.connection_.reset(connection);
  if (connection == nullptr)
    return hal::fail(hal::ErrorCode::io, database.name_, "open", "no memory for a connection");
  if (code != SQLITE_OK) return database.failure(code, "open");
  // SQLite opens a file it may not write for reading and says so only at the first write.
  if (access != SqliteAccess::read && sqlite3_db_readonly(connection, "main") == 1)
    return hal::fail(hal::ErrorCode::permission, database.name_, "open", "the file may only be read",
                     "Check its owner and rights, and whether the disk is mounted read-only");
  sqlite3_extended_result_codes(connection, 1);
  const auto wait = std::chrono::ceil<std::chrono::milliseconds>(busy_wait).count();
  sqlite3_busy_timeout(connection, static_cast<int>(wait));
  return database;
}

hal::Failure SqliteDatabase::failure(int code, std::string operation) const {
  const int system_errno = sqlite3_system_errno(connection_.get());
  const hal::ErrorCode portable_code = portable(code, system_errno);
  const bool errno_explains = portable_code == hal::ErrorCode::io || (code & 0xFF) == SQLITE_CANTOPEN;
  return hal::fail(portable_code, name_, std::move(operation), sqlite3_errstr(code), mend_for(code),
                   errno_explains ? system_errno : 0);
}

hal::Result<> SqliteDatabase::execute(const std::string& sql, const std::string& operation) const {
  const int code = sqlite3_exec(connection_.get(), sql.c_str(), nullptr, nullptr, nullptr);
  if (code != SQLITE_OK) return failure(code, operation);
  return {};
}

hal::Result<SqliteStatement> SqliteDatabase::prepare(std::string_view sql) const {
  sqlite3_stmt* statement = nullptr;
  const int code = sqlite3_prepare_v3(connection_.get(), sql.data(), static_cast<int>(sql.size()),
                                      SQLITE_PREPARE_PERSISTENT, &statement, nullptr);
  SqliteStatement owned(statement);
  if (code != SQLITE_OK) return failure(code, "prepare a query");
  return owned;
}

hal::Result<std::int64_t> SqliteDatabase::query_integer(std::string_view sql) const {
  auto statement = prepare(sql);
  if (!statement) return hal::fail(std::move(statement).error());
  const int code = statement->step();
  if (code != SQLITE_ROW) return failure(code == SQLITE_DONE ? SQLITE_CORRUPT : code, "read the header");
  return statement->integer(0);
}

}  // namespace forager::reader
