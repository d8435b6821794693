#include "reader/sqlite_schema.hpp"

#include <fmt/format.h>

namespace forager::reader {
namespace {

constexpr std::int64_t kApplicationId = 0x466F7267;  // "Forg"; file(1) and we know the file by it
constexpr std::int64_t kSchemaVersion = 1;

// Times are nanoseconds on the run's time line. A pose of NULLs was not known.
constexpr const char* kSchema = R"sql(
BEGIN IMMEDIATE;
CREATE TABLE item(
  epc BLOB PRIMARY KEY, reads INTEGER NOT NULL, first_seen_ns INTEGER NOT NULL, last_seen_ns INTEGER NOT NULL,
  best_rssi_dbm INTEGER NOT NULL, best_port INTEGER NOT NULL,
  x_m REAL, y_m REAL, z_m REAL, yaw_rad REAL, pitch_rad REAL, roll_rad REAL) WITHOUT ROWID;
CREATE TABLE port(port INTEGER PRIMARY KEY, reads INTEGER NOT NULL);
CREATE TABLE fact(key TEXT PRIMARY KEY, value TEXT NOT NULL) WITHOUT ROWID;
CREATE TABLE progress(one INTEGER PRIMARY KEY CHECK(one = 1), last_batch INTEGER NOT NULL);
INSERT INTO progress VALUES(1, 0);
CREATE TABLE read(
  batch INTEGER NOT NULL, epc BLOB NOT NULL, port INTEGER NOT NULL, rssi_dbm INTEGER NOT NULL,
  phase_deg REAL, frequency_khz INTEGER, reads INTEGER NOT NULL, reader_ms INTEGER NOT NULL,
  heard_ns INTEGER NOT NULL, arrived_ns INTEGER NOT NULL,
  x_m REAL, y_m REAL, z_m REAL, yaw_rad REAL, pitch_rad REAL, roll_rad REAL);
)sql";

}  // namespace

hal::Result<bool> identify_inventory(const SqliteDatabase& database) {
  const auto id = database.query_integer("PRAGMA application_id");
  if (!id) return hal::fail(id.error());
  const auto version = database.query_integer("PRAGMA user_version");
  if (!version) return hal::fail(version.error());
  const auto tables = database.query_integer("SELECT count(*) FROM sqlite_master");
  if (!tables) return hal::fail(tables.error());
  if (*id == 0 && *version == 0 && *tables == 0) return false;
  if (*id != kApplicationId)
    return hal::fail(hal::ErrorCode::protocol, database.name(), "open",
                     "this is a SQLite file of some other program", "Name a file that forager wrote");
  if (*version != kSchemaVersion)
    return hal::fail(hal::ErrorCode::protocol, database.name(), "open",
                     fmt::format("the file has layout {}, this program knows {}", *version, kSchemaVersion),
                     "Use the version of forager that wrote it, or a later one");
  return true;
}

hal::Result<> lay_out_inventory(const SqliteDatabase& database) {
  return database.execute(fmt::format("{} PRAGMA application_id={}; PRAGMA user_version={}; COMMIT;", kSchema,
                                      kApplicationId, kSchemaVersion),
                          "create tables");
}

}  // namespace forager::reader
