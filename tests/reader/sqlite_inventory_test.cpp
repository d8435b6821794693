#include <fcntl.h>
#include <gtest/gtest.h>
#include <sys/wait.h>
#include <unistd.h>

#include <array>
#include <chrono>
#include <csignal>
#include <cstdio>
#include <filesystem>
#include <fstream>
#include <map>
#include <thread>

#include "reader/inventory_store.hpp"
#include "tests/reader/inventory_samples.hpp"
#include "tests/scratch_folder.hpp"

namespace forager::reader {
namespace {

using test::sample_batch;
using namespace std::chrono_literals;
namespace fs = std::filesystem;

class SqliteInventory : public testing::Test {
 protected:
  void SetUp() override {
    const auto probe = open_sqlite_inventory(folder_.file("probe.db"), StoreMode::create);
    if (!probe && probe.error().code == hal::ErrorCode::unsupported) GTEST_SKIP() << "built without SQLite";
  }

  std::unique_ptr<InventoryStore> open(StoreMode mode) {
    auto store = open_sqlite_inventory(path_, mode);
    EXPECT_TRUE(store) << describe(store.error());
    return store ? std::move(*store) : nullptr;
  }

  hal::Error refusal(StoreMode mode) {
    const auto store = open_sqlite_inventory(path_, mode);
    EXPECT_FALSE(store);
    return store ? hal::Error{} : store.error();
  }

  void write_file(const std::string& bytes) { std::ofstream(path_, std::ios::binary) << bytes; }

  test::ScratchFolder folder_;
  std::string path_ = folder_.file("run.db");
};

TEST_F(SqliteInventory, AClosedInventoryIsOneFileThatCanBeContinuedAndRead) {
  {
    auto store = open(StoreMode::create);
    for (std::uint64_t batch = 1; batch <= 3; ++batch) ASSERT_TRUE(store->commit(batch, sample_batch(batch)));
    ASSERT_TRUE(store->set_fact("policy", "soan"));
  }
  EXPECT_TRUE(fs::exists(path_));
  EXPECT_FALSE(fs::exists(path_ + "-wal"));
  EXPECT_FALSE(fs::exists(path_ + "-shm"));
  {
    auto store = open(StoreMode::resume);
    EXPECT_EQ(store->last_batch(), 3U);
    ASSERT_TRUE(store->commit(4, sample_batch(4)));
  }
  auto reader = open(StoreMode::read);
  EXPECT_EQ(reader->last_batch(), 4U);
  EXPECT_EQ(reader->facts().value()[0].second, "soan");
  auto memory = make_memory_inventory();
  for (std::uint64_t batch = 1; batch <= 4; ++batch) ASSERT_TRUE(memory->commit(batch, sample_batch(batch)));
  test::expect_same_items(memory->items().value(), reader->items().value());
}

TEST_F(SqliteInventory, ReadingNeverWrites) {
  open(StoreMode::create);
  auto reader = open(StoreMode::read);
  EXPECT_EQ(reader->commit(1, sample_batch(1)).error().code, hal::ErrorCode::invalid_state);
  EXPECT_EQ(reader->set_fact("a", "b").error().code, hal::ErrorCode::invalid_state);
}

TEST_F(SqliteInventory, AReportCanBeReadWhileTheMissionWrites) {
  auto writer = open(StoreMode::create);
  ASSERT_TRUE(writer->commit(1, sample_batch(1)));
  auto reader = open(StoreMode::read);
  ASSERT_TRUE(writer->commit(2, sample_batch(2)));
  test::expect_same_items(writer->items().value(), reader->items().value());
}

TEST_F(SqliteInventory, TwoWritersNeverCountTheSameNumberTwice) {
  auto first = open(StoreMode::create);
  auto second = open(StoreMode::resume);
  ASSERT_TRUE(first->commit(1, sample_batch(1)));
  const auto before = first->items().value();
  ASSERT_TRUE(second->commit(1, sample_batch(2)));
  EXPECT_EQ(second->last_batch(), 1U);
  test::expect_same_items(before, second->items().value());
}

TEST_F(SqliteInventory, CreateRefusesWhatExistsAndReadWhatDoesNot) {
  EXPECT_EQ(refusal(StoreMode::read).code, hal::ErrorCode::not_present);
  EXPECT_FALSE(fs::exists(path_)) << "reading must not create";
  open(StoreMode::create);
  EXPECT_EQ(refusal(StoreMode::create).code, hal::ErrorCode::invalid_argument);
}

TEST_F(SqliteInventory, AMissingFolderIsSaidSo) {
  const auto store = open_sqlite_inventory(folder_.file("no/such/folder/run.db"), StoreMode::resume);
  ASSERT_FALSE(store);
  EXPECT_EQ(store.error().code, hal::ErrorCode::not_present);
  EXPECT_FALSE(store.error().mend.empty());
}

TEST_F(SqliteInventory, ATextFileIsRefusedAndLeftAlone) {
  const std::string text(5000, 'x');
  write_file(text);
  for (const StoreMode mode : {StoreMode::resume, StoreMode::read}) {
    const hal::Error error = refusal(mode);
    EXPECT_EQ(error.code, hal::ErrorCode::protocol) << describe(error);
    EXPECT_NE(describe(error).find(path_), std::string::npos);
  }
  std::ifstream in(path_, std::ios::binary);
  EXPECT_EQ(std::string(std::istreambuf_iterator<char>(in), {}), text);
}

// Bytes 60..63 and 68..71 of a SQLite file are its user version and application id (SQLite file format, 1.3).
void patch(const std::string& path, std::streamoff at, std::uint8_t value) {
  std::fstream file(path, std::ios::in | std::ios::out | std::ios::binary);
  file.seekp(at);
  file.put(static_cast<char>(value));
}

TEST_F(SqliteInventory, AFileOfAnotherProgramIsRefused) {
  open(StoreMode::create);
  patch(path_, 71, 0x00);
  const hal::Error error = refusal(StoreMode::resume);
  EXPECT_EQ(error.code, hal::ErrorCode::protocol);
  EXPECT_NE(error.detail.find("other program"), std::string::npos);
}

TEST_F(SqliteInventory, AFileOfALaterLayoutIsRefusedWithBothNumbers) {
  open(StoreMode::create);
  patch(path_, 63, 9);
  const hal::Error error = refusal(StoreMode::resume);
  EXPECT_EQ(error.code, hal::ErrorCode::protocol);
  EXPECT_NE(error.detail.find("layout 9"), std::string::npos);
  EXPECT_FALSE(error.mend.empty());
}

TEST_F(SqliteInventory, AnEmptyFileLeftByAKillIsTakenWhenResumingAndRefusedWhenReading) {
  write_file("");
  EXPECT_EQ(refusal(StoreMode::read).code, hal::ErrorCode::protocol);
  EXPECT_EQ(open(StoreMode::resume)->last_batch(), 0U);
}

TEST_F(SqliteInventory, TheReadLogCostsNothingUnlessAskedFor) {
  StoreOptions options;
  options.mode = StoreMode::create;
  const std::string quiet = folder_.file("quiet.db");
  for (const bool log : {false, true}) {
    options.log_reads = log;
    auto store = open_sqlite_inventory(log ? path_ : quiet, options);
    for (std::uint64_t batch = 1; batch <= 40; ++batch)
      ASSERT_TRUE((*store)->commit(batch, sample_batch(batch)));
  }
  const auto logged = fs::file_size(path_) - fs::file_size(quiet);
  EXPECT_GT(logged, 40U * 50U * 60U);
  EXPECT_LT(logged, 40U * 50U * 160U);
}

// --- Kill at any moment ------------------------------------------------------------------------------------

constexpr std::uint64_t kCloseEvery = 12;

// The recorder: goes on where the store stands, sends every number it is unsure of again, and acknowledges
// each batch on the pipe once commit() has returned. Never ends of itself.
[[noreturn]] void record_forever(const std::string& path, int acknowledge_fd) {
  for (;;) {
    auto store = open_sqlite_inventory(path, StoreMode::resume);
    if (!store) _exit(3);
    const std::uint64_t start = (*store)->last_batch();
    for (std::uint64_t batch = start == 0 ? 1 : start; batch < start + kCloseEvery; ++batch) {
      if (!(*store)->commit(batch, sample_batch(batch))) _exit(4);
      if (write(acknowledge_fd, &batch, sizeof batch) != static_cast<ssize_t>(sizeof batch)) _exit(5);
    }
  }
}

// Runs a recorder, kills it `delay` after its acknowledgement number `heard` (0: after its start), and gives
// the last batch it acknowledged (0: none). Counting acknowledgements keeps the moments where they matter
// however busy the machine is.
std::uint64_t record_and_kill(const std::string& path, std::uint64_t heard, std::chrono::microseconds delay) {
  std::array<int, 2> ends{};
  if (pipe2(ends.data(), O_CLOEXEC) != 0) throw std::runtime_error("no pipe");
  const pid_t child = fork();
  if (child == 0) record_forever(path, ends[1]);
  close(ends[1]);
  std::uint64_t last = 0;
  std::uint64_t number = 0;
  const auto next = [&] {
    const bool more = read(ends[0], &number, sizeof number) == static_cast<ssize_t>(sizeof number);
    if (more) last = number;
    return more;
  };
  while (heard > 0 && next()) --heard;
  std::this_thread::sleep_for(delay);
  kill(child, SIGKILL);
  int status = 0;
  waitpid(child, &status, 0);
  EXPECT_TRUE(WIFSIGNALED(status)) << "the recorder ended by itself with " << WEXITSTATUS(status);
  while (next()) continue;
  close(ends[0]);
  return last;
}

TEST_F(SqliteInventory, AKillAtAnyMomentLosesNothingAcknowledgedAndCountsNothingTwice) {
  hal::Random random(2026);
  auto model = make_memory_inventory();
  std::uint64_t acknowledged = 0;
  int unacknowledged_but_whole = 0;
  for (int round = 0; round < 80; ++round) {
    SCOPED_TRACE(round);
    // Some lives are too short to get past opening and recovery, some span several closings.
    const std::uint64_t heard = round % 4 == 0 ? 0 : random.below(2 * kCloseEvery);
    const auto delay = std::chrono::microseconds(random.below(heard == 0 ? 5000 : 600));
    acknowledged = std::max(acknowledged, record_and_kill(path_, heard, delay));
    if (!fs::exists(path_)) continue;
    auto store = open(StoreMode::resume);
    ASSERT_NE(store, nullptr);
    ASSERT_GE(store->last_batch(), acknowledged) << "an acknowledged batch is gone";
    ASSERT_LE(store->last_batch(), acknowledged + 1);
    if (store->last_batch() > acknowledged) ++unacknowledged_but_whole;
    // Whatever the store says it has, it has wholly, and nothing else.
    while (model->last_batch() < store->last_batch())
      ASSERT_TRUE(model->commit(model->last_batch() + 1, sample_batch(model->last_batch() + 1)));
    test::expect_same_items(model->items().value(), store->items().value());
    acknowledged = store->last_batch();
  }
  EXPECT_GT(acknowledged, 500U);
  std::printf("%llu batches, %d of them whole though never acknowledged\n",
              static_cast<unsigned long long>(acknowledged), unacknowledged_but_whole);
}

TEST_F(SqliteInventory, ACommitDoesNotWaitForTheDisk) {
  auto store = open(StoreMode::create);
  constexpr std::uint64_t kBatches = 200;
  const auto start = std::chrono::steady_clock::now();
  for (std::uint64_t batch = 1; batch <= kBatches; ++batch)
    ASSERT_TRUE(store->commit(batch, sample_batch(batch)));
  const std::chrono::duration<double, std::micro> each =
      (std::chrono::steady_clock::now() - start) / kBatches;
  std::printf("%.0f us for a batch of 50 reads\n", each.count());
  EXPECT_LT(each.count(), 20000.0) << "a commit must not wait for the disk by default";
}

}  // namespace
}  // namespace forager::reader
