#include "reader/inventory_store.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <filesystem>
#include <functional>

#include "tests/reader/inventory_samples.hpp"
#include "tests/scratch_folder.hpp"

namespace forager::reader {
namespace {

using test::sample_batch;
using namespace std::chrono_literals;

// What every inventory promises, whatever keeps it.
class InventoryContract : public testing::TestWithParam<const char*> {
 protected:
  void SetUp() override {
    if (std::string(GetParam()) == "memory") {
      store_ = make_memory_inventory();
      return;
    }
    auto opened = open_sqlite_inventory(folder_.file("run.db"), StoreMode::create);
    if (!opened && opened.error().code == hal::ErrorCode::unsupported) GTEST_SKIP() << "built without SQLite";
    ASSERT_TRUE(opened) << describe(opened.error());
    store_ = std::move(*opened);
  }

  static LocatedRead read_of(const char* epc, std::uint8_t port, int rssi, hal::Duration heard) {
    LocatedRead located;
    located.read.epc = Epc::from_hex(epc).value();
    located.read.port = port;
    located.read.rssi_dbm = static_cast<std::int16_t>(rssi);
    located.read.heard = hal::Instant(heard);
    return located;
  }

  test::ScratchFolder folder_;
  std::unique_ptr<InventoryStore> store_;
};

TEST_P(InventoryContract, StartsEmpty) {
  EXPECT_EQ(store_->last_batch(), 0U);
  EXPECT_TRUE(store_->items().value().empty());
  EXPECT_TRUE(store_->facts().value().empty());
  EXPECT_TRUE(store_->port_totals().value().empty());
}

TEST_P(InventoryContract, FoldsTheReadsOfAnEpcIntoOneItem) {
  LocatedRead weak = read_of("30390001", 4, -70, 5s);
  LocatedRead strong = read_of("30390001", 2, -50, 3s);  // heard earlier, arrives later
  strong.read.read_count = 3;
  strong.pose_known = true;
  strong.pose_world = {{1.5, -2.0, 1.2}, 0.5, 0.1, -0.1};
  const LocatedRead equal = read_of("30390001", 1, -50, 9s);
  ASSERT_TRUE(store_->commit(1, std::vector{weak, strong}));
  ASSERT_TRUE(store_->commit(2, std::vector{equal}));
  const auto items = store_->items().value();
  ASSERT_EQ(items.size(), 1U);
  EXPECT_EQ(items[0].count, 5U);
  EXPECT_EQ(items[0].first_seen, hal::Instant(3s));
  EXPECT_EQ(items[0].last_seen, hal::Instant(9s));
  EXPECT_EQ(items[0].best_rssi_dbm, -50);
  EXPECT_EQ(items[0].best_port, 2) << "of equally strong reads the first one stays";
  EXPECT_TRUE(items[0].pose_known);
  EXPECT_EQ(items[0].best_pose_world.position, (hal::Vec3{1.5, -2.0, 1.2}));
  EXPECT_EQ(items[0].best_pose_world.yaw_rad, 0.5);
}

TEST_P(InventoryContract, AStrongerReadWithoutAPoseTakesThePoseAway) {
  LocatedRead located = read_of("30390001", 4, -70, 1s);
  located.pose_known = true;
  ASSERT_TRUE(store_->commit(1, std::vector{located, read_of("30390001", 4, -60, 2s)}));
  EXPECT_FALSE(store_->items().value()[0].pose_known);
}

TEST_P(InventoryContract, ABatchSentTwiceCountsOnce) {
  ASSERT_TRUE(store_->commit(1, sample_batch(1)));
  ASSERT_TRUE(store_->commit(2, sample_batch(2)));
  const auto before = store_->items().value();
  ASSERT_TRUE(store_->commit(2, sample_batch(2)));
  ASSERT_TRUE(store_->commit(1, sample_batch(1)));
  EXPECT_EQ(store_->last_batch(), 2U);
  test::expect_same_items(before, store_->items().value());
}

TEST_P(InventoryContract, AGapInTheNumbersIsRefusedAndStoresNothing) {
  ASSERT_TRUE(store_->commit(1, sample_batch(1)));
  const auto before = store_->items().value();
  for (const std::uint64_t wrong : {std::uint64_t{0}, std::uint64_t{3}}) {
    const auto refused = store_->commit(wrong, sample_batch(3));
    ASSERT_FALSE(refused);
    EXPECT_EQ(refused.error().code, hal::ErrorCode::invalid_argument);
    EXPECT_NE(describe(refused.error()).find("next number is 2"), std::string::npos);
  }
  EXPECT_EQ(store_->last_batch(), 1U);
  test::expect_same_items(before, store_->items().value());
}

TEST_P(InventoryContract, AnEmptyBatchMovesTheNumberOnly) {
  ASSERT_TRUE(store_->commit(1, {}));
  EXPECT_EQ(store_->last_batch(), 1U);
  EXPECT_TRUE(store_->items().value().empty());
}

TEST_P(InventoryContract, ItemsComeOrderedByEpcAPrefixFirst) {
  ASSERT_TRUE(store_->commit(1, std::vector{read_of("bb00", 1, -60, 1s), read_of("aa000000", 1, -60, 1s),
                                            read_of("aa00", 1, -60, 1s), read_of("aaff", 1, -60, 1s)}));
  std::vector<std::string> order;
  const auto items = store_->items().value();
  for (const InventoryItem& item : items) order.push_back(item.epc.hex());
  EXPECT_EQ(order, (std::vector<std::string>{"aa00", "aa000000", "aaff", "bb00"}));
}

TEST_P(InventoryContract, AFactKeepsItsLastValueAndAnyText) {
  ASSERT_TRUE(store_->set_fact("seed", "1"));
  ASSERT_TRUE(store_->set_fact("scene", "l'entrep\xc3\xb4t \"A\"; DROP TABLE item"));
  ASSERT_TRUE(store_->set_fact("seed", "2"));
  const auto facts = store_->facts().value();
  ASSERT_EQ(facts.size(), 2U);
  EXPECT_EQ(facts[0],
            std::pair(std::string("scene"), std::string("l'entrep\xc3\xb4t \"A\"; DROP TABLE item")));
  EXPECT_EQ(facts[1].second, "2");
}

TEST_P(InventoryContract, PortTotalsAddUpToTheInventory) {
  for (std::uint64_t batch = 1; batch <= 10; ++batch) ASSERT_TRUE(store_->commit(batch, sample_batch(batch)));
  const auto items = store_->items().value();
  std::uint64_t reads = 0;
  for (const InventoryItem& item : items) reads += item.count;
  std::uint64_t port_reads = 0;
  std::uint64_t port_items = 0;
  std::uint8_t last_port = 0;
  const auto totals = store_->port_totals().value();
  for (const PortTotal& total : totals) {
    EXPECT_GT(total.port, last_port);
    last_port = total.port;
    port_reads += total.reads;
    port_items += total.items;
    EXPECT_EQ(total.items, static_cast<std::uint64_t>(std::count_if(
                               items.begin(), items.end(),
                               [&](const InventoryItem& item) { return item.best_port == total.port; })));
  }
  EXPECT_EQ(port_reads, reads);
  EXPECT_EQ(port_items, items.size());
}

INSTANTIATE_TEST_SUITE_P(Stores, InventoryContract, testing::Values("memory", "sqlite"),
                         [](const auto& kind) { return std::string(kind.param); });

}  // namespace
}  // namespace forager::reader
