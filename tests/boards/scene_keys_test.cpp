// docs/boards.md is the reference of the scene and board files: every key that the readers know is in it with
// what they allow, and nothing else is.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <fstream>
#include <map>
#include <set>
#include <sstream>
#include <string>
#include <vector>

#include "boards/scene.hpp"
#include "tests/places.hpp"

namespace forager::boards {
namespace {

using testing::HasSubstr;

struct DocumentedKey {
  std::string fallback;
  std::string allowed;
};
using Section = std::map<std::string, DocumentedKey>;

std::string without(std::string text, const std::string& what) {
  for (auto at = text.find(what); at != std::string::npos; at = text.find(what)) text.erase(at, what.size());
  return text;
}

std::vector<std::string> cells_of(const std::string& row) {
  std::vector<std::string> cells;
  std::istringstream in(row);
  for (std::string cell; std::getline(in, cell, '|');) {
    const auto first = cell.find_first_not_of(' ');
    const auto last = cell.find_last_not_of(' ');
    cells.push_back(first == std::string::npos ? "" : cell.substr(first, last - first + 1));
  }
  return cells;
}

// Sections "vehicle", "reader.port", ... of the page, by their headings.
std::map<std::string, Section> documented() {
  std::ifstream page(test::source_path("docs/boards.md"));
  std::map<std::string, Section> sections;
  std::string section;
  for (std::string line; std::getline(page, line);) {
    if (line.starts_with("### `[")) {
      section = without(without(without(line.substr(5), "["), "]"), "`");
    } else if (!section.empty() && line.starts_with("| `")) {
      const auto cells = cells_of(line);
      sections[section][without(cells[1], "`")] = {without(cells[2], "`"), without(cells[3], "`")};
    }
  }
  return sections;
}

// Every table and list of tables is there, so that every key is asked for.
constexpr const char* kEverySection = R"(
scene = { name = "x" }
vehicle = {}
camera = {}
localisation = {}
reader = { session = "S0", port = [{ port = 1, bearing_deg = 0 }] }
guard = {}
mission = { policy = "stigmergy" }
links = {}
world.shelves = [{ min = [0, 0, 0], max = [1, 1, 1] }]
world.groups = [{ tags = 1, centres = [[0, 0, 0]] }]
world.radio = {}
world.generate = { kind = "aisles" }
world.skip = {}
world.air = {}
)";

void collect(const ConfigNode& node, const std::string& path,
             std::map<std::string, std::set<std::string>>& out) {
  if (const auto* items = node.array())
    for (const ConfigNode& item : *items) collect(item, path, out);
  const auto* members = node.table();
  if (members == nullptr) return;
  if (!path.empty()) out[path].insert(node.asked.begin(), node.asked.end());
  for (const auto& [key, value] : *members) collect(value, path.empty() ? key : path + "." + key, out);
}

TEST(SceneKeys, TheReferenceHasEveryKeyThereIsAndNoOther) {
  const auto node = parse_config(kEverySection, "all.toml");
  ASSERT_TRUE(node) << describe(node.error());
  const auto scene = read_scene(*node, "all.toml");
  ASSERT_TRUE(scene) << describe(scene.error());
  std::map<std::string, std::set<std::string>> known;
  collect(*node, "", known);
  std::map<std::string, std::set<std::string>> in_the_page;
  for (const auto& [section, keys] : documented())
    for (const auto& [key, what] : keys) in_the_page[section].insert(key);
  EXPECT_EQ(in_the_page, known);
  EXPECT_GT(known.size(), 12U);
}

// The scene above with one key set to a value.
hal::Result<Scene> scene_with(const std::string& section, const std::string& key, const std::string& value) {
  auto node = parse_config(kEverySection, "all.toml");
  const auto given = parse_config("value = " + value, "all.toml");
  if (!node) return hal::fail(node.error());
  if (!given) return hal::fail(given.error());
  ConfigNode* at = &*node;
  std::istringstream path(section);
  for (std::string name; std::getline(path, name, '.');) {
    for (auto& [member, child] : std::get<ConfigNode::Table>(at->value))
      if (member == name) {
        at = &child;
        break;
      }
    if (auto* items = std::get_if<ConfigNode::Array>(&at->value)) at = &items->front();
  }
  auto& table = std::get<ConfigNode::Table>(at->value);
  std::erase_if(table, [&key](const auto& member) { return member.first == key; });
  table.emplace_back(key, *given->find("value"));
  return read_scene(*node, "all.toml");
}

std::string complaint_about(const std::string& section, const std::string& key, const std::string& value) {
  const auto scene = scene_with(section, key, value);
  return scene ? "accepted" : describe(scene.error());
}

TEST(SceneKeys, WhatTheReferenceAllowsIsWhatTheReadersAllow) {
  std::size_t ranges = 0;
  std::size_t choices = 0;
  for (const auto& [section, keys] : documented()) {
    for (const auto& [key, what] : keys) {
      SCOPED_TRACE("[" + section + "] " + key + ": " + what.allowed);
      std::string allowed = what.allowed.starts_with("list, ") ? what.allowed.substr(6) : what.allowed;
      if (allowed == "0.05 to vehicle.max_speed_m_s") allowed = "0.05 to 1";
      const bool is_list = allowed != what.allowed && what.allowed.starts_with("list, ");
      if (std::isdigit(allowed.front()) != 0 || allowed.front() == '-') {
        if (allowed.find(" to ") == std::string::npos) continue;  // "2 numbers"
        ++ranges;
        const double high = std::stod(allowed.substr(allowed.find(" to ") + 4));
        const std::string above = std::to_string(static_cast<long long>(high) + 1);
        const std::string said = complaint_about(section, key, is_list ? "[" + above + "]" : above);
        // The large ones are printed by the readers in their own way.
        if (high < 1e6) {
          EXPECT_THAT(said, HasSubstr(allowed + "."));
        }
        EXPECT_THAT(said, HasSubstr("is " + above));
        const std::string low = allowed.substr(0, allowed.find(" to "));
        EXPECT_THAT(complaint_about(section, key, is_list ? "[-1000]" : "-1000"), HasSubstr("is -1000"))
            << low;
      } else if (allowed == "true, false") {
        EXPECT_THAT(complaint_about(section, key, "1"), HasSubstr("Write true or false"));
      } else if (allowed.find(", ") != std::string::npos && !allowed.starts_with("list")) {
        ++choices;
        EXPECT_THAT(complaint_about(section, key, "\"none of them\""),
                    HasSubstr("Allowed: " + allowed + "."));
      } else if (allowed == "text") {
        EXPECT_THAT(complaint_about(section, key, "1"), HasSubstr("not a string"));
      }
    }
  }
  EXPECT_GT(ranges, 60U);
  EXPECT_GE(choices, 5U);
}

TEST(SceneKeys, TheDefaultsInTheReferenceAreTheReaders) {
  const auto node = parse_config(kEverySection, "all.toml");
  const auto bare = read_scene(*node, "all.toml");
  ASSERT_TRUE(bare);
  std::size_t compared = 0;
  for (const auto& [section, keys] : documented()) {
    for (const auto& [key, what] : keys) {
      const bool choice = what.allowed.find(what.fallback + ", ") != std::string::npos && key != "name";
      const bool number = std::string("-[0123456789").find(what.fallback.front()) != std::string::npos;
      if (!number && !choice) continue;
      SCOPED_TRACE("[" + section + "] " + key + " = " + what.fallback);
      const bool bareword = number || what.fallback == "true" || what.fallback == "false";
      const auto written = scene_with(section, key, bareword ? what.fallback : '"' + what.fallback + '"');
      ASSERT_TRUE(written) << describe(written.error());
      EXPECT_TRUE(*written == *bare);
      ++compared;
    }
  }
  EXPECT_GT(compared, 60U);
}

}  // namespace
}  // namespace forager::boards
