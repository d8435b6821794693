#pragma once

#include <cstddef>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "hal/error.hpp"

namespace forager::boards {

// A strict reader of comma separated values: one header line that names every wanted column once, in any
// order, and nothing else; as many fields on every line; no quotes, no empty fields, no empty lines but at
// the end. CR LF and a byte order mark are taken. Numbers are decimal and finite.
class CsvTable {
 public:
  // `name` stands in errors, "reads.csv". Errors: invalid_argument with line and column.
  [[nodiscard]] static hal::Result<CsvTable> parse(std::string_view text, std::string name,
                                                   std::span<const std::string_view> columns);

  [[nodiscard]] std::size_t rows() const { return lines_.size(); }
  // Column by its place in `columns`.
  [[nodiscard]] std::string_view field(std::size_t row, std::size_t column) const {
    return fields_[row * columns_.size() + column];
  }
  // Errors: invalid_argument with line and column, for what is no number or not within [low, high].
  [[nodiscard]] hal::Result<double> number(std::size_t row, std::size_t column, double low,
                                           double high) const;
  [[nodiscard]] hal::Result<long> whole(std::size_t row, std::size_t column, long low, long high) const;
  // For checks of the caller's own.
  [[nodiscard]] hal::Error error(std::size_t row, std::size_t column, std::string detail) const;

 private:
  std::string name_;
  std::vector<std::string> columns_;
  std::vector<std::size_t> lines_;  // line number of each row
  std::vector<std::string_view> fields_;
  std::vector<char> text_;  // what the fields look into; moves keep it in place
};

// All of a file. Errors: not_present, permission, io; invalid_argument above most_bytes.
[[nodiscard]] hal::Result<std::string> read_text_file(const std::string& path, std::size_t most_bytes);

}  // namespace forager::boards
