#include "tools/page_frame.hpp"

#include "tools/report_markup.hpp"
#include "tools/report_style.hpp"

namespace forager::tools {

void begin_page(std::string& out, std::string_view title) {
  put(out,
      "<!DOCTYPE html>\n<html lang=\"en\" xmlns=\"http://www.w3.org/1999/xhtml\">\n<head>\n<meta "
      "charset=\"utf-8\"/>\n<meta name=\"viewport\" content=\"width=device-width, initial-scale=1\"/>\n"
      "<title>{}</title>\n<style>{}</style>\n</head>\n<body>\n",
      title, report_style());
}

void end_page(std::string& out, std::string_view footer) {
  put(out, "</main>\n<footer>Written by forager. {}</footer>\n</body>\n</html>\n", footer);
}

void begin_table(std::string& out, std::string_view heading, const std::vector<PageColumn>& columns,
                 bool full_width) {
  put(out, "<section class=\"card{}\">\n<h2>{}</h2>\n<table><thead><tr>", full_width ? " full" : "", heading);
  for (const PageColumn& column : columns)
    put(out, "<th scope=\"col\"{}>{}</th>", column.number ? " class=\"number\"" : "", column.heading);
  out += "</tr></thead><tbody>\n";
}

void end_table(std::string& out) { out += "</tbody></table>\n</section>\n"; }

void put_number(std::string& out, std::string_view text) { put(out, "<td class=\"number\">{}</td>", text); }

}  // namespace forager::tools
