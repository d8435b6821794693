#pragma once

#include <string>
#include <string_view>
#include <vector>

namespace forager::tools {

// What self-contained pages begin and end with: valid as HTML and as XML, the report's style sheet inside, no
// script, nothing loaded from elsewhere. Texts must be safe markup (escape_markup()).
//
// Up to and with the open <body>.
void begin_page(std::string& out, std::string_view title);
// Closes main, and all that begin_page() opened.
void end_page(std::string& out, std::string_view footer);

struct PageColumn {
  std::string_view heading;
  bool number = true;  // right-aligned
};

// A card as wide as the page with a table, up to its open <tbody>; closed by end_table().
void begin_table(std::string& out, std::string_view heading, const std::vector<PageColumn>& columns,
                 bool full_width = true);
void end_table(std::string& out);

// A cell with a number, right-aligned.
void put_number(std::string& out, std::string_view text);

}  // namespace forager::tools
