#include "reader/inventory_export.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <limits>

#include "tests/reader/inventory_samples.hpp"

namespace forager::reader {
namespace {

using namespace std::chrono_literals;

InventoryItem item(const char* epc, std::int16_t rssi, hal::Duration first, hal::Duration last) {
  InventoryItem made;
  made.epc = Epc::from_hex(epc).value();
  made.count = 7;
  made.first_seen = hal::Instant(first);
  made.last_seen = hal::Instant(last);
  made.best_rssi_dbm = rssi;
  made.best_port = 4;
  return made;
}

TEST(InventoryExport, CsvHasAHeaderAndOneCrLfLinePerItemWithTheSameNumberOfFields) {
  InventoryItem located = item("30390001", -61, 1500ms, 2s);
  located.pose_known = true;
  located.best_pose_world = {{1.25, -0.5, 1.2}, 0.1, 0.0, 0.0};
  const std::string csv = to_csv(std::vector{located, item("30390002", -70, 0ns, 345ns)});
  EXPECT_EQ(csv,
            "epc,reads,first_seen_s,last_seen_s,best_rssi_dbm,best_port,x_m,y_m,z_m,yaw_rad\r\n"
            "30390001,7,1.500000000,2.000000000,-61,4,1.25,-0.5,1.2,0.1\r\n"
            "30390002,7,0.000000000,0.000000345,-70,4,,,,\r\n");
}

TEST(InventoryExport, JsonLinesSayNullWhereNoPoseCanBeTrusted) {
  InventoryItem broken = item("30390001", -61, 1s, 2s);
  broken.pose_known = true;
  broken.best_pose_world.position.x = std::numeric_limits<double>::quiet_NaN();
  EXPECT_EQ(to_json_lines(std::vector{broken}),
            "{\"type\":\"item\",\"epc\":\"30390001\",\"reads\":7,\"first_seen_s\":1.000000000,"
            "\"last_seen_s\":2.000000000,\"best_rssi_dbm\":-61,\"best_port\":4,"
            "\"x_m\":null,\"y_m\":null,\"z_m\":null,\"yaw_rad\":null}\n");
}

TEST(InventoryExport, SecondsAreExactOnBothSidesOfZero) {
  EXPECT_EQ(exact_seconds(hal::Instant(1ns)), "0.000000001");
  EXPECT_EQ(exact_seconds(hal::Instant(-1500ms)), "-1.500000000");
  EXPECT_EQ(exact_seconds(hal::Instant(hal::Duration::min())), "-9223372036.854775808");
}

TEST(InventoryExport, TheSummaryCoversAllItems) {
  std::vector<InventoryItem> items{item("30390001", -40, 5s, 6s), item("30390002", -80, 2s, 3s),
                                   item("30390003", -70, 4s, 9s), item("30390004", -60, 4s, 5s)};
  items[1].pose_known = true;
  const InventorySummary summary = summarize(items);
  EXPECT_EQ(summary.items, 4U);
  EXPECT_EQ(summary.reads, 28U);
  EXPECT_EQ(summary.located, 1U);
  EXPECT_EQ(summary.first_seen, hal::Instant(2s));
  EXPECT_EQ(summary.last_seen, hal::Instant(9s));
  EXPECT_EQ(summary.strongest_dbm, -40);
  EXPECT_EQ(summary.median_best_dbm, -70);
  EXPECT_EQ(summary.weakest_best_dbm, -80);
  EXPECT_EQ(summarize({}).items, 0U);
}

}  // namespace
}  // namespace forager::reader
