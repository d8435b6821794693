#include <fmt/format.h>
#include <gtest/gtest.h>

#include <fstream>
#include <map>
#include <sstream>
#include <string>
#include <vector>

#include "flight/mavlink/crc.hpp"
#include "flight/mavlink/registry.hpp"
#include "tests/places.hpp"

namespace forager::flight::mavlink {
namespace {

std::map<std::string, std::string> official_facts() {
  std::map<std::string, std::string> facts;
  std::ifstream file(forager::test::data_path("mavlink/messages.csv"));
  for (std::string line; std::getline(file, line);)
    if (!line.empty() && line.front() != '#') facts[line.substr(0, line.find(','))] = line;
  return facts;
}

template <Message M>
std::string our_facts(const M& /*type*/) {
  constexpr auto& kShape = kLayout<M>;
  std::string line = fmt::format("{},{},{},{},{},", M::kName, M::kId, kShape.crc_extra, kShape.base_length,
                                 kShape.full_length);
  for (const std::size_t index : kShape.wire_order) {
    const FieldLayout& field = kShape.fields[index];
    if (line.back() != ',') line += ' ';
    line += fmt::format("{}:{}{}:{}", field.offset, field.type,
                        field.count == 0 ? "" : fmt::format("[{}]", field.count), field.name);
  }
  return line;
}

TEST(MavlinkMessages, LayoutsAndCrcExtrasAreThoseOfTheOfficialDefinitions) {
  const auto facts = official_facts();
  ASSERT_EQ(facts.size(), AllMessages::kSize);
  for_each_message([&](const auto& message) {
    const auto found = facts.find(std::string(message.kName));
    ASSERT_NE(found, facts.end()) << message.kName;
    EXPECT_EQ(our_facts(message), found->second);
  });
}

TEST(MavlinkMessages, RegistryFindsEachKnownIdAndNoOther) {
  std::size_t found = 0;
  for (std::uint32_t id = 0; id < 70'000; ++id) {
    const MessageInfo* const info = find_message(id);
    if (info == nullptr) continue;
    ++found;
    EXPECT_EQ(info->id, id);
  }
  EXPECT_EQ(found, AllMessages::kSize);
  EXPECT_EQ(find_message(11030)->name, "ESC_TELEMETRY_1_TO_4");
  EXPECT_EQ(find_message(0xFFFFFF), nullptr);
}

TEST(MavlinkCrc, MatchesTheCheckValueOfCrc16Mcrf4xx) {
  EXPECT_EQ(crc_add(kCrcStart, "123456789"), 0x6F91);
  static_assert(crc_add(kCrcStart, "123456789") == 0x6F91);
}

TEST(MavlinkCrc, EightAtATimeEqualsOneAtATimeForEveryLength) {
  std::vector<std::byte> bytes;
  std::uint16_t slow = kCrcStart;
  for (unsigned i = 0; i < 300; ++i) {
    ASSERT_EQ(crc_add(kCrcStart, bytes), slow) << i;
    const auto next = static_cast<std::uint8_t>(i * 151 + 43);
    bytes.push_back(std::byte{next});
    slow = crc_add(slow, next);
  }
}

}  // namespace
}  // namespace forager::flight::mavlink
