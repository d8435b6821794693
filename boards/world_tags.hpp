#pragma once

#include <cstddef>
#include <cstdint>
#include <string>
#include <vector>

#include "hal/error.hpp"
#include "hal/pose.hpp"
#include "reader/inventory_store.hpp"

namespace forager::mocks {
class TagList;
}

namespace forager::boards {

// The tags of the simulated world, looked at where they lie: nothing is copied. The world must outlive it.
class WorldTags {
 public:
  WorldTags() = default;  // no tags
  explicit WorldTags(const mocks::TagList& tags) : tags_(&tags) {}

  [[nodiscard]] std::size_t size() const;
  [[nodiscard]] hal::Vec3 position(std::size_t tag) const;
  [[nodiscard]] bool wanted(std::size_t tag) const;
  [[nodiscard]] std::string epc_hex(std::size_t tag) const;

 private:
  friend struct ReadTags;
  const mocks::TagList* tags_ = nullptr;
};

// What of a world is in an inventory. Linear in tags and items.
struct ReadTags {
  std::vector<std::uint32_t> tags;  // that were read, ascending; where two have one EPC the first
  std::size_t wanted_present = 0;
  std::size_t wanted_read = 0;
  std::size_t others_read = 0;  // bystanders, and EPCs that are not in the world

  // Errors: those of the store.
  [[nodiscard]] static hal::Result<ReadTags> find(const WorldTags& world,
                                                  const reader::InventoryStore& inventory);
};

}  // namespace forager::boards
