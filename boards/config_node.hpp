#pragma once

#include <cstdint>
#include <string>
#include <string_view>
#include <utility>
#include <variant>
#include <vector>

#include "hal/error.hpp"

namespace forager::boards {

// A parsed configuration value with where it stands, free of the TOML library. Tables keep the order of the
// file.
struct ConfigNode {
  using Table = std::vector<std::pair<std::string, ConfigNode>>;
  using Array = std::vector<ConfigNode>;

  std::variant<Table, Array, std::string, std::int64_t, double, bool> value = Table{};
  std::string file;
  std::uint32_t line = 0;
  mutable bool used = false;  // a reader has asked for it; what nobody asked for is an unknown key
  mutable std::vector<std::string> asked;  // keys a reader of this table knows, present or not

  [[nodiscard]] const Table* table() const { return std::get_if<Table>(&value); }
  [[nodiscard]] const Array* array() const { return std::get_if<Array>(&value); }
  // The member of a table, or null.
  [[nodiscard]] const ConfigNode* find(std::string_view key) const;
  [[nodiscard]] std::string where() const;      // "scenes/4A.toml:12"
  [[nodiscard]] std::string_view kind() const;  // "a table", "a string", ...
};

// Parses TOML 1.0. Errors: invalid_argument (not TOML; the operation has line and column), unsupported (a
// date or time).
[[nodiscard]] hal::Result<ConfigNode> parse_config(std::string_view text, const std::string& file);

// Reads a file and, when it has a top-level key `base = "other.toml"` (relative to it), lays it over that
// file: tables are merged key by key, everything else (arrays included) is replaced. Errors: not_present,
// permission, unsupported, invalid_argument (not TOML, or a chain of more than eight bases).
[[nodiscard]] hal::Result<ConfigNode> load_config(const std::string& path);

}  // namespace forager::boards
