#include "tools/layout_output.hpp"

#include <fmt/format.h>

#include <iterator>
#include <nlohmann/json.hpp>

namespace forager::tools {

using boards::LayoutCheck;
using Json = nlohmann::ordered_json;

std::string layout_line(const LayoutCheck& check) {
  std::string out = fmt::format("{} of {} in place, {} elsewhere, {} unheard, {} not listed", check.in_place,
                                check.listed, check.elsewhere.size(), check.unheard, check.strangers.size());
  if (check.unplaced > 0) out += fmt::format(", {} heard without a pose", check.unplaced);
  return out;
}

Json layout_json(const LayoutCheck& check) {
  return Json{{"listed", check.listed},     {"in_place", check.in_place},
              {"unheard", check.unheard},   {"elsewhere", check.elsewhere.size()},
              {"unplaced", check.unplaced}, {"strangers", check.strangers.size()}};
}

std::string layout_table(const LayoutCheck& check) {
  std::string out = fmt::format("Layout\n  {}\n", layout_line(check));
  for (const LayoutCheck::Elsewhere& tag : check.elsewhere)
    fmt::format_to(std::back_inserter(out),
                   "  {}  listed at ({:.2f}, {:.2f}, {:.2f}), heard strongest from ({:.2f}, {:.2f}, {:.2f}): "
                   "{:.1f} m away\n",
                   tag.epc.hex(), tag.listed.x, tag.listed.y, tag.listed.z, tag.heard_from.x,
                   tag.heard_from.y, tag.heard_from.z, tag.away_m);
  for (const reader::Epc& epc : check.strangers)
    fmt::format_to(std::back_inserter(out), "  {}  not listed\n", epc.hex());
  return out;
}

std::string layout_json_lines(const LayoutCheck& check) {
  const auto place = [](hal::Vec3 p) { return Json{p.x, p.y, p.z}; };
  Json head{{"type", "layout"}};
  head.update(layout_json(check));
  std::string out = head.dump() + "\n";
  for (const LayoutCheck::Elsewhere& tag : check.elsewhere)
    out += Json{{"type", "elsewhere"},
                {"epc", tag.epc.hex()},
                {"listed", place(tag.listed)},
                {"heard_from", place(tag.heard_from)},
                {"away_m", tag.away_m}}
               .dump() +
           "\n";
  for (const reader::Epc& epc : check.strangers)
    out += Json{{"type", "stranger"}, {"epc", epc.hex()}}.dump() + "\n";
  return out;
}

}  // namespace forager::tools
