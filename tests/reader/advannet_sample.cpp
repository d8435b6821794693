#include "tests/reader/advannet_sample.hpp"

#include <fmt/format.h>
#include <gtest/gtest.h>

#include <fstream>
#include <iterator>

#include "tests/places.hpp"

namespace forager::test {

std::string advannet_file(std::string_view name) {
  const std::string path = data_path("advannet/" + std::string(name));
  std::ifstream file(path, std::ios::binary);
  EXPECT_TRUE(file) << path;
  return {std::istreambuf_iterator<char>(file), {}};
}

std::string advannet_item(std::string_view epc, long long ts_ms, std::string_view props) {
  return fmt::format(
      "<item><class>READ_EVENT</class><epc>{0}</epc><decoded></decoded><ts>{1}</ts>"
      "<deviceId>AdvanReader-m4-160</deviceId><data><class>TAG_DATA</class><hexepc>{0}</hexepc><tid></tid>"
      "<data></data><props>{2}</props></data><location><class>LOCATION_DEFINITION</class><loc></loc>"
      "<ts></ts></location></item>",
      epc, ts_ms, props);
}

std::string advannet_inventory(std::string_view items) {
  return fmt::format(
      "<?xml version=\"1.0\" encoding=\"UTF-8\"?>\n<inventory><type>inventory</type><ts>1779868346683</ts>"
      "<status>OK</status><msg-version>2.3.0</msg-version><op>inventory</op><data>"
      "<deviceId>AdvanReader-m4-160</deviceId><inventory><class>INVENTORY</class><size>1</size>"
      "<items>{}</items></inventory></data></inventory>",
      items);
}

std::string advannet_frame(std::string_view body) {
  return fmt::format("ADVANNET/1.1\r\nContent-Length:{}\r\nContent-Type:text/xml\r\n\r\n{}\r\n\r\n",
                     body.size(), body);
}

}  // namespace forager::test
