#include "boards/layout_check.hpp"

#include <algorithm>
#include <unordered_map>

#include "mocks/tag_file.hpp"

namespace forager::boards {

LayoutCheck check_layout(const std::vector<reader::InventoryItem>& items, const mocks::TagList& layout,
                         double reach_m) {
  LayoutCheck check;
  check.listed = layout.size();
  std::unordered_map<reader::Epc, const reader::InventoryItem*> sought;
  sought.reserve(items.size());
  for (const reader::InventoryItem& item : items) sought.emplace(item.epc, &item);
  for (std::size_t tag = 0; tag < layout.size(); ++tag) {
    const auto epc = reader::Epc::from_hex(layout.epc_hex(tag));
    const auto found = epc ? sought.find(*epc) : sought.end();
    if (found == sought.end()) {
      ++check.unheard;
      continue;
    }
    const reader::InventoryItem& item = *found->second;
    sought.erase(found);
    if (!item.pose_known) {
      ++check.unplaced;
      continue;
    }
    const hal::Vec3 listed = layout.position(tag);
    const double away_m = norm(listed - item.best_pose_world.position);
    if (away_m <= reach_m)
      ++check.in_place;
    else
      check.elsewhere.push_back({item.epc, listed, item.best_pose_world.position, away_m});
  }
  std::stable_sort(check.elsewhere.begin(), check.elsewhere.end(),
                   [](const auto& a, const auto& b) { return a.away_m > b.away_m; });
  for (const auto& [epc, item] : sought) check.strangers.push_back(epc);
  std::sort(check.strangers.begin(), check.strangers.end(), [](const reader::Epc& a, const reader::Epc& b) {
    return std::ranges::lexicographical_compare(a.bytes(), b.bytes());
  });
  return check;
}

hal::Result<LayoutCheck> check_layout_file(const std::vector<reader::InventoryItem>& items,
                                           const std::string& path, double reach_m) {
  mocks::TagList layout;
  FORAGER_TRY(mocks::read_tag_file(path, layout));
  return check_layout(items, layout, reach_m);
}

}  // namespace forager::boards
