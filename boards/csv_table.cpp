#include "boards/csv_table.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cerrno>
#include <charconv>
#include <cmath>
#include <cstdio>
#include <memory>

namespace forager::boards {
namespace {

hal::Error bad(const std::string& name, std::size_t line, std::string_view column, std::string detail) {
  return {hal::ErrorCode::invalid_argument,
          name,
          column.empty() ? fmt::format("line {}", line) : fmt::format("line {}, column {}", line, column),
          std::move(detail),
          {},
          0};
}

std::vector<std::string_view> split(std::string_view line) {
  std::vector<std::string_view> fields;
  for (std::size_t start = 0;;) {
    const std::size_t comma = line.find(',', start);
    fields.push_back(line.substr(start, comma == std::string_view::npos ? comma : comma - start));
    if (comma == std::string_view::npos) return fields;
    start = comma + 1;
  }
}

// What a person sees of a field that may hold anything.
std::string shown(std::string_view field) {
  std::string out(field.substr(0, 40));
  for (char& c : out)
    if (static_cast<unsigned char>(c) < 0x20 || static_cast<unsigned char>(c) >= 0x7F) c = '?';
  return field.size() > 40 ? out + "..." : out;
}

// Where each wanted column stands in the file.
hal::Result<std::vector<std::size_t>> places_of(const std::vector<std::string_view>& header,
                                                std::span<const std::string_view> wanted,
                                                const std::string& name) {
  for (std::size_t i = 0; i < header.size(); ++i) {
    if (std::find(wanted.begin(), wanted.end(), header[i]) == wanted.end())
      return hal::fail(
          bad(name, 1, fmt::format("{}", i + 1), fmt::format("unknown name '{}'", shown(header[i]))));
    if (std::find(header.begin(), header.begin() + static_cast<std::ptrdiff_t>(i), header[i]) !=
        header.begin() + static_cast<std::ptrdiff_t>(i))
      return hal::fail(bad(name, 1, fmt::format("{}", i + 1), fmt::format("'{}' stands twice", header[i])));
  }
  std::vector<std::size_t> places;
  for (const std::string_view column : wanted) {
    const auto found = std::find(header.begin(), header.end(), column);
    if (found == header.end())
      return hal::fail(bad(name, 1, {}, fmt::format("the header has no column '{}'", column)));
    places.push_back(static_cast<std::size_t>(found - header.begin()));
  }
  return places;
}

}  // namespace

hal::Result<CsvTable> CsvTable::parse(std::string_view text, std::string name,
                                      std::span<const std::string_view> columns) {
  if (text.starts_with("\xEF\xBB\xBF")) text.remove_prefix(3);
  CsvTable table;
  table.name_ = std::move(name);
  table.columns_.assign(columns.begin(), columns.end());
  table.text_.assign(text.begin(), text.end());
  const std::string_view all(table.text_.data(), table.text_.size());
  std::vector<std::size_t> places;
  std::size_t line_number = 0;
  std::size_t empty_line = 0;
  for (std::size_t start = 0; start < all.size();) {
    const std::size_t end = std::min(all.find('\n', start), all.size());
    std::string_view line = all.substr(start, end - start);
    start = end + 1;
    ++line_number;
    if (line.ends_with('\r')) line.remove_suffix(1);
    if (line.empty()) {
      if (empty_line == 0) empty_line = line_number;
      continue;
    }
    if (empty_line != 0) return hal::fail(bad(table.name_, empty_line, {}, "is empty"));
    const auto fields = split(line);
    if (line_number == 1) {
      auto found = places_of(fields, columns, table.name_);
      if (!found) return hal::fail(std::move(found).error());
      places = std::move(*found);
      continue;
    }
    if (fields.size() != columns.size())
      return hal::fail(bad(table.name_, line_number, {},
                           fmt::format("has {} fields, the header {}", fields.size(), columns.size())));
    table.lines_.push_back(line_number);
    for (std::size_t i = 0; i < places.size(); ++i) {
      if (fields[places[i]].empty()) return hal::fail(bad(table.name_, line_number, columns[i], "is empty"));
      table.fields_.push_back(fields[places[i]]);
    }
  }
  if (places.empty()) return hal::fail(bad(table.name_, 1, {}, "there is no header"));
  return table;
}

hal::Error CsvTable::error(std::size_t row, std::size_t column, std::string detail) const {
  return bad(name_, lines_[row], columns_[column], std::move(detail));
}

hal::Result<double> CsvTable::number(std::size_t row, std::size_t column, double low, double high) const {
  const std::string_view text = field(row, column);
  double value = 0.0;
  const auto [end, code] = std::from_chars(text.data(), text.data() + text.size(), value);
  if (code != std::errc{} || end != text.data() + text.size() || !std::isfinite(value))
    return hal::fail(error(row, column, fmt::format("'{}' is not a number", shown(text))));
  if (value < low || value > high)
    return hal::fail(error(row, column, fmt::format("{} is not within {} to {}", value, low, high)));
  return value;
}

hal::Result<long> CsvTable::whole(std::size_t row, std::size_t column, long low, long high) const {
  const std::string_view text = field(row, column);
  long value = 0;
  const auto [end, code] = std::from_chars(text.data(), text.data() + text.size(), value);
  if (code != std::errc{} || end != text.data() + text.size())
    return hal::fail(error(row, column, fmt::format("'{}' is not a whole number", shown(text))));
  if (value < low || value > high)
    return hal::fail(error(row, column, fmt::format("{} is not within {} to {}", value, low, high)));
  return value;
}

hal::Result<std::string> read_text_file(const std::string& path, std::size_t most_bytes) {
  const std::unique_ptr<std::FILE, int (*)(std::FILE*)> file(std::fopen(path.c_str(), "rb"), std::fclose);
  if (!file) {
    const int number = errno;
    const auto code = number == ENOENT   ? hal::ErrorCode::not_present
                      : number == EACCES ? hal::ErrorCode::permission
                                         : hal::ErrorCode::io;
    return hal::fail(code, path, "open", "cannot be read", {}, number);
  }
  std::string text;
  char block[1U << 16U];
  while (const std::size_t got = std::fread(block, 1, sizeof block, file.get())) {
    text.append(block, got);
    if (text.size() > most_bytes)
      return hal::fail(hal::ErrorCode::invalid_argument, path, "read",
                       fmt::format("is above {} bytes", most_bytes));
  }
  if (std::ferror(file.get()) != 0) return hal::fail(hal::ErrorCode::io, path, "read", "failed", {}, errno);
  return text;
}

}  // namespace forager::boards
