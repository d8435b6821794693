#include <fmt/format.h>

#include <array>
#include <filesystem>
#include <optional>
#include <system_error>
#include <utility>

#include "reader/inventory_store.hpp"
#include "reader/sqlite_database.hpp"
#include "reader/sqlite_schema.hpp"

namespace forager::reader {
namespace {

// The strongest read brings its port and pose along; of equals the first one stays.
constexpr const char* kFoldItem = R"sql(
INSERT INTO item VALUES(?1, ?2, ?3, ?3, ?4, ?5, ?6, ?7, ?8, ?9, ?10, ?11)
ON CONFLICT(epc) DO UPDATE SET
  reads = reads + excluded.reads,
  first_seen_ns = min(first_seen_ns, excluded.first_seen_ns),
  last_seen_ns = max(last_seen_ns, excluded.last_seen_ns),
  best_rssi_dbm = max(best_rssi_dbm, excluded.best_rssi_dbm),
  best_port = iif(excluded.best_rssi_dbm > best_rssi_dbm, excluded.best_port, best_port),
  x_m = iif(excluded.best_rssi_dbm > best_rssi_dbm, excluded.x_m, x_m),
  y_m = iif(excluded.best_rssi_dbm > best_rssi_dbm, excluded.y_m, y_m),
  z_m = iif(excluded.best_rssi_dbm > best_rssi_dbm, excluded.z_m, z_m),
  yaw_rad = iif(excluded.best_rssi_dbm > best_rssi_dbm, excluded.yaw_rad, yaw_rad),
  pitch_rad = iif(excluded.best_rssi_dbm > best_rssi_dbm, excluded.pitch_rad, pitch_rad),
  roll_rad = iif(excluded.best_rssi_dbm > best_rssi_dbm, excluded.roll_rad, roll_rad))sql";
constexpr const char* kFoldPort =
    "INSERT INTO port VALUES(?1, ?2) ON CONFLICT(port) DO UPDATE SET reads = reads + excluded.reads";
constexpr const char* kLogRead =
    "INSERT INTO read VALUES(?1, ?2, ?3, ?4, ?5, ?6, ?7, ?8, ?9, ?10, ?11, ?12, ?13, ?14, ?15, ?16)";
constexpr const char* kPortTotals =
    "SELECT port, reads, (SELECT count(*) FROM item WHERE best_port = port.port) FROM port ORDER BY port";
constexpr const char* kSetFact =
    "INSERT INTO fact VALUES(?1, ?2) ON CONFLICT(key) DO UPDATE SET value = excluded.value";

constexpr int kPoseColumns = 6;
constexpr int kOk = 0;     // SQLITE_OK
constexpr int kRow = 100;  // SQLITE_ROW
constexpr int kDone = 101;

std::int64_t nanoseconds(hal::Instant t) { return t.time_since_epoch().count(); }

void bind_pose(SqliteStatement& statement, int first, const LocatedRead& located) {
  const hal::Pose& pose = located.pose_world;
  const std::array<double, kPoseColumns> values{pose.position.x, pose.position.y, pose.position.z,
                                                pose.yaw_rad,    pose.pitch_rad,  pose.roll_rad};
  for (int i = 0; i < kPoseColumns; ++i) {
    if (located.pose_known)
      statement.bind(first + i, values[static_cast<std::size_t>(i)]);
    else
      statement.bind_null(first + i);
  }
}

class SqliteInventory final : public InventoryStore {
 public:
  SqliteInventory(SqliteDatabase database, const StoreOptions& options, std::uint64_t last_batch)
      : database_(std::move(database)),
        writes_(options.mode != StoreMode::read),
        log_reads_(options.log_reads),
        last_batch_(last_batch) {}

  // Leaving WAL takes the log into the file, so that what remains is one plain file that can be copied,
  // archived and read from a read-only disk. If somebody still reads it, the next opening does that instead.
  ~SqliteInventory() override {
    if (writes_) (void)database_.execute("PRAGMA journal_mode=DELETE", "close");
  }
  SqliteInventory(const SqliteInventory&) = delete;
  SqliteInventory& operator=(const SqliteInventory&) = delete;

  hal::Result<> prepare() {
    const std::array<std::pair<SqliteStatement*, const char*>, 8> statements{{
        {&begin_, "BEGIN IMMEDIATE"},
        {&end_, "COMMIT"},
        {&get_progress_, "SELECT last_batch FROM progress"},
        {&set_progress_, "UPDATE progress SET last_batch = ?1"},
        {&fold_item_, kFoldItem},
        {&fold_port_, kFoldPort},
        {&log_read_, kLogRead},
        {&set_fact_, kSetFact},
    }};
    for (const auto& [statement, sql] : statements) {
      auto prepared = database_.prepare(sql);
      if (!prepared) return hal::fail(std::move(prepared).error());
      *statement = std::move(*prepared);
    }
    return {};
  }

  hal::Result<> commit(std::uint64_t batch, std::span<const LocatedRead> reads) override {
    const std::string operation = fmt::format("store batch {}", batch);
    FORAGER_TRY(check_writable(operation));
    if (const int code = begin_.run(); code != kOk) return database_.failure(code, operation);
    auto stored = store(batch, reads, operation);
    if (stored && *stored == batch) {
      if (const int code = end_.run(); code != kOk) stored = database_.failure(code, operation);
    }
    // A no-op after COMMIT; otherwise leaves the file as it was before this batch.
    if (!stored || *stored != batch) (void)database_.execute("ROLLBACK", operation);
    if (!stored) return hal::fail(std::move(stored).error());
    last_batch_ = *stored;
    return {};
  }

  std::uint64_t last_batch() const override { return last_batch_; }

  hal::Result<std::vector<InventoryItem>> items() const override {
    std::vector<InventoryItem> items;
    FORAGER_TRY(each_row("SELECT * FROM item ORDER BY epc", [&](const SqliteStatement& row) -> hal::Result<> {
      auto epc = Epc::from_bytes(row.blob(0));
      if (!epc)
        return hal::fail(hal::ErrorCode::protocol, database_.name(), "list items", epc.error().detail);
      InventoryItem item;
      item.epc = *epc;
      item.count = static_cast<std::uint64_t>(row.integer(1));
      item.first_seen = hal::Instant(hal::Duration(row.integer(2)));
      item.last_seen = hal::Instant(hal::Duration(row.integer(3)));
      item.best_rssi_dbm = static_cast<std::int16_t>(row.integer(4));
      item.best_port = static_cast<std::uint8_t>(row.integer(5));
      item.pose_known = !row.is_null(6);
      if (item.pose_known)
        item.best_pose_world = {
            {row.real(6), row.real(7), row.real(8)}, row.real(9), row.real(10), row.real(11)};
      items.push_back(item);
      return {};
    }));
    return items;
  }

  hal::Result<> set_fact(const std::string& key, const std::string& value) override {
    const std::string operation = "keep fact " + key;
    FORAGER_TRY(check_writable(operation));
    set_fact_.bind(0, std::string_view(key));
    set_fact_.bind(1, std::string_view(value));
    if (const int code = set_fact_.run(); code != kOk) return database_.failure(code, operation);
    return {};
  }

  hal::Result<std::vector<std::pair<std::string, std::string>>> facts() const override {
    std::vector<std::pair<std::string, std::string>> facts;
    FORAGER_TRY(each_row("SELECT key, value FROM fact ORDER BY key", [&](const SqliteStatement& row) {
      facts.emplace_back(row.text(0), row.text(1));
      return hal::Result<>();
    }));
    return facts;
  }

  hal::Result<std::vector<PortTotal>> port_totals() const override {
    std::vector<PortTotal> totals;
    FORAGER_TRY(each_row(kPortTotals, [&](const SqliteStatement& row) {
      totals.push_back({static_cast<std::uint8_t>(row.integer(0)), static_cast<std::uint64_t>(row.integer(1)),
                        static_cast<std::uint64_t>(row.integer(2))});
      return hal::Result<>();
    }));
    return totals;
  }

 private:
  hal::Result<> check_writable(const std::string& operation) const {
    if (writes_) return {};
    return hal::fail(hal::ErrorCode::invalid_state, database_.name(), operation,
                     "it was opened for reading only");
  }

  // Within the transaction. The number of the last batch in the store, which is `batch` if it went in now.
  hal::Result<std::uint64_t> store(std::uint64_t batch, std::span<const LocatedRead> reads,
                                   const std::string& operation) {
    // Asked anew each time: another process may have continued this inventory.
    if (const int code = get_progress_.step(); code != kRow) {
      get_progress_.reset();
      return database_.failure(code, operation);
    }
    const auto stored = static_cast<std::uint64_t>(get_progress_.integer(0));
    get_progress_.reset();
    if (batch == 0 || batch > stored + 1)
      return hal::fail(hal::ErrorCode::invalid_argument, database_.name(), operation,
                       fmt::format("the next number is {}", stored + 1));
    if (batch <= stored) return stored;

    std::array<std::uint64_t, 256> reads_by_port{};
    for (const LocatedRead& located : reads) {
      reads_by_port[located.read.port] += located.read.read_count;
      if (const int code = fold(located); code != kOk) return database_.failure(code, operation);
      if (!log_reads_) continue;
      if (const int code = log(batch, located); code != kOk) return database_.failure(code, operation);
    }
    for (std::size_t port = 0; port < reads_by_port.size(); ++port) {
      if (reads_by_port[port] == 0) continue;
      fold_port_.bind(0, static_cast<std::int64_t>(port));
      fold_port_.bind(1, static_cast<std::int64_t>(reads_by_port[port]));
      if (const int code = fold_port_.run(); code != kOk) return database_.failure(code, operation);
    }
    set_progress_.bind(0, static_cast<std::int64_t>(batch));
    if (const int code = set_progress_.run(); code != kOk) return database_.failure(code, operation);
    return batch;
  }

  int fold(const LocatedRead& located) {
    const TagRead& read = located.read;
    fold_item_.bind(0, read.epc.bytes());
    fold_item_.bind(1, std::int64_t{read.read_count});
    fold_item_.bind(2, nanoseconds(read.heard));
    fold_item_.bind(3, std::int64_t{read.rssi_dbm});
    fold_item_.bind(4, std::int64_t{read.port});
    bind_pose(fold_item_, 5, located);
    return fold_item_.run();
  }

  int log(std::uint64_t batch, const LocatedRead& located) {
    const TagRead& read = located.read;
    log_read_.bind(0, static_cast<std::int64_t>(batch));
    log_read_.bind(1, read.epc.bytes());
    log_read_.bind(2, std::int64_t{read.port});
    log_read_.bind(3, std::int64_t{read.rssi_dbm});
    if (read.phase_deg)
      log_read_.bind(4, *read.phase_deg);
    else
      log_read_.bind_null(4);
    log_read_.bind(5, std::int64_t{read.frequency_khz});
    log_read_.bind(6, std::int64_t{read.read_count});
    log_read_.bind(7, read.reader_ms);
    log_read_.bind(8, nanoseconds(read.heard));
    log_read_.bind(9, nanoseconds(read.arrived));
    bind_pose(log_read_, 10, located);
    return log_read_.run();
  }

  template <class Row>
  hal::Result<> each_row(const char* sql, Row&& take) const {
    auto statement = database_.prepare(sql);
    if (!statement) return hal::fail(std::move(statement).error());
    int code = kRow;
    while ((code = statement->step()) == kRow) FORAGER_TRY(take(std::as_const(*statement)));
    if (code != kDone) return database_.failure(code, "list");
    return {};
  }

  // The connection comes first so that it outlives its statements.
  SqliteDatabase database_;
  SqliteStatement begin_, end_, get_progress_, set_progress_, fold_item_, fold_port_, log_read_, set_fact_;
  bool writes_;
  bool log_reads_;
  std::uint64_t last_batch_;
};

hal::Result<SqliteAccess> access_for(const std::string& path, StoreMode mode) {
  std::error_code ignored;
  const bool exists = std::filesystem::exists(path, ignored);
  if (mode == StoreMode::create && exists)
    return hal::fail(hal::ErrorCode::invalid_argument, "inventory " + path, "create",
                     "the file exists already", "Give another name, or resume it");
  if (mode == StoreMode::read && !exists)
    return hal::fail(hal::ErrorCode::not_present, "inventory " + path, "open", "there is no such file",
                     "Name the inventory.sqlite in the output folder of a run");
  return mode == StoreMode::read ? SqliteAccess::read : SqliteAccess::create;
}

}  // namespace

bool have_sqlite_inventory() { return true; }

hal::Result<std::unique_ptr<InventoryStore>> open_sqlite_inventory(const std::string& path,
                                                                   const StoreOptions& options) {
  const auto access = access_for(path, options.mode);
  if (!access) return hal::fail(access.error());
  auto database = SqliteDatabase::open(path, *access, options.busy_wait);
  if (!database) return hal::fail(std::move(database).error());
  const auto ours = identify_inventory(*database);
  if (!ours) return hal::fail(ours.error());
  if (options.mode == StoreMode::read) {
    if (!*ours)
      return hal::fail(hal::ErrorCode::protocol, database->name(), "open", "the file is empty",
                       "Name a file that forager wrote");
  } else {
    FORAGER_TRY(database->execute("PRAGMA journal_mode=WAL", "open"));
    FORAGER_TRY(database->execute(
        options.durability == Durability::power ? "PRAGMA synchronous=FULL" : "PRAGMA synchronous=NORMAL",
        "open"));
    if (!*ours) FORAGER_TRY(lay_out_inventory(*database));
  }
  const auto last = database->query_integer("SELECT last_batch FROM progress");
  if (!last) return hal::fail(last.error());
  auto store =
      std::make_unique<SqliteInventory>(std::move(*database), options, static_cast<std::uint64_t>(*last));
  FORAGER_TRY(store->prepare());
  return store;
}

}  // namespace forager::reader
