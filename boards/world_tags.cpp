#include "boards/world_tags.hpp"

#include <algorithm>
#include <unordered_set>

#include "mocks/tag_list.hpp"

namespace forager::boards {
namespace {

// The EPCs of an inventory; each is found once.
class Sought {
 public:
  explicit Sought(const std::vector<reader::InventoryItem>& items) {
    short_.reserve(items.size());
    for (const reader::InventoryItem& item : items) {
      const auto bytes = item.epc.bytes();
      if (bytes.size() != mocks::Epc96{}.size()) {
        odd_.insert(item.epc.hex());
        continue;
      }
      mocks::Epc96 epc{};
      std::copy(bytes.begin(), bytes.end(), epc.begin());
      short_.insert(epc);
    }
  }
  bool take(const mocks::TagList& tags, std::size_t tag) {
    if (const mocks::Epc96* const epc = tags.epc96(tag)) return short_.erase(*epc) > 0;
    return !odd_.empty() && odd_.erase(tags.epc_hex(tag)) > 0;
  }
  [[nodiscard]] std::size_t left() const { return short_.size() + odd_.size(); }

 private:
  std::unordered_set<mocks::Epc96, mocks::HashOfEpc96> short_;
  std::unordered_set<std::string> odd_;
};

}  // namespace

std::size_t WorldTags::size() const { return tags_ != nullptr ? tags_->size() : 0; }
hal::Vec3 WorldTags::position(std::size_t tag) const { return tags_->position(tag); }
bool WorldTags::wanted(std::size_t tag) const { return tags_->wanted(tag); }
std::string WorldTags::epc_hex(std::size_t tag) const { return tags_->epc_hex(tag); }

hal::Result<ReadTags> ReadTags::find(const WorldTags& world, const reader::InventoryStore& inventory) {
  const auto items = inventory.items();
  if (!items) return hal::fail(items.error());
  ReadTags found;
  Sought sought(*items);
  for (std::size_t tag = 0; tag < world.size(); ++tag) {
    const bool wanted = world.wanted(tag);
    if (wanted) ++found.wanted_present;
    if (sought.left() == 0 || !sought.take(*world.tags_, tag)) continue;
    found.tags.push_back(static_cast<std::uint32_t>(tag));
    (wanted ? found.wanted_read : found.others_read) += 1;
  }
  found.others_read += sought.left();
  return found;
}

}  // namespace forager::boards
