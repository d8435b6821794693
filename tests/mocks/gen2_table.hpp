#pragma once

#include <fstream>
#include <map>
#include <sstream>
#include <string>
#include <vector>

#include "tests/places.hpp"

namespace forager::mocks {

// Rows of tests/data/gen2/<name>, by column; lines with # are comments, the first other one is the heading.
using TableRow = std::map<std::string, std::string>;
inline std::vector<TableRow> gen2_table(const std::string& name) {
  std::ifstream file(forager::test::data_path("gen2/") + name);
  std::vector<std::string> heading;
  std::vector<TableRow> rows;
  for (std::string line; std::getline(file, line);) {
    if (line.starts_with("#")) continue;
    std::istringstream cells(line);
    std::vector<std::string> values;
    for (std::string cell; std::getline(cells, cell, ',');) values.push_back(cell);
    if (heading.empty()) {
      heading = values;
      continue;
    }
    TableRow row;
    for (std::size_t i = 0; i < values.size(); ++i) row[heading[i]] = values[i];
    rows.push_back(row);
  }
  return rows;
}
inline double number(const TableRow& row, const std::string& column) { return std::stod(row.at(column)); }

}  // namespace forager::mocks
