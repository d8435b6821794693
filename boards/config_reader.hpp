#pragma once

#include <cstdint>
#include <initializer_list>
#include <limits>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "boards/config_node.hpp"
#include "hal/time.hpp"

namespace forager::boards {

struct Range {
  double min = -std::numeric_limits<double>::infinity();
  double max = std::numeric_limits<double>::infinity();
};

// The first mistake found in a configuration; readers share one and go quiet after it.
using ConfigIssue = std::optional<hal::Error>;

// Strict view of one table. Every getter checks type and range; a wrong value becomes the issue, naming file,
// line, key, value and what is allowed. A missing key gives the fallback; require() makes it an issue. Keys
// that no getter asked for are found by check_unused().
class ConfigReader {
 public:
  // `node` may be null: an absent table, all fallbacks; then `around` says where it is missed.
  ConfigReader(const ConfigNode* node, std::string path, ConfigIssue& issue,
               const ConfigNode* around = nullptr);

  [[nodiscard]] bool present() const { return node_ != nullptr; }
  [[nodiscard]] bool has(std::string_view key) const;
  void require(std::string_view key, std::string_view what);

  [[nodiscard]] double number(std::string_view key, double fallback, Range allowed);
  [[nodiscard]] std::optional<double> optional_number(std::string_view key, Range allowed);
  [[nodiscard]] std::int64_t integer(std::string_view key, std::int64_t fallback, Range allowed);
  [[nodiscard]] bool flag(std::string_view key, bool fallback);
  [[nodiscard]] std::string text(std::string_view key, std::string_view fallback);
  [[nodiscard]] std::string choice(std::string_view key, std::string_view fallback,
                                   std::initializer_list<std::string_view> allowed);
  // A number of seconds (key ends in _s) or milliseconds (_ms).
  [[nodiscard]] hal::Duration duration(std::string_view key, hal::Duration fallback, Range allowed);
  // An array of exactly `size` finite numbers; empty when the key is missing.
  [[nodiscard]] std::vector<double> numbers(std::string_view key, std::size_t size);
  // An array of numbers of any length.
  [[nodiscard]] std::vector<double> number_list(std::string_view key, Range allowed);
  // An array of points of `size` numbers each.
  [[nodiscard]] std::vector<std::vector<double>> points(std::string_view key, std::size_t size);

  [[nodiscard]] ConfigReader table(std::string_view key);
  [[nodiscard]] std::vector<ConfigReader> tables(std::string_view key);

  // Makes `detail` about `key` the issue (first one wins).
  void complain(std::string_view key, std::string detail, std::string mend);

 private:
  const ConfigNode* take(std::string_view key);
  std::optional<double> as_number(const ConfigNode& node, std::string_view key, Range allowed);
  std::optional<std::vector<double>> as_numbers(const ConfigNode& node, std::string_view key,
                                                std::size_t size);

  const ConfigNode* node_;
  const ConfigNode* nearest_ = nullptr;  // the table itself, or the nearest one around it that is there
  std::string path_;
  ConfigIssue* issue_;
};

// Makes the first key nobody asked for the issue, with the nearest known spelling if one is close.
void check_unused(const ConfigNode& root, ConfigIssue& issue);

}  // namespace forager::boards
