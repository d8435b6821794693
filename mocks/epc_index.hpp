#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <unordered_map>
#include <vector>

#include "mocks/tag_list.hpp"

namespace forager::mocks {

// Finds two tags with one EPC while a list grows: 8 to 16 bytes a tag, linear time.
class EpcIndex {
 public:
  // Knows what is in the list already.
  explicit EpcIndex(const TagList& tags);
  // Takes in the tag that was added to the list last; the tag that has its EPC already, if there is one.
  std::optional<std::size_t> add_last() { return add(tags_->size() - 1); }

 private:
  std::optional<std::size_t> add(std::size_t tag);
  void grow();
  [[nodiscard]] std::size_t place_of(const Epc96& epc) const;

  static constexpr std::uint32_t kEmpty = 0xFFFFFFFF;
  const TagList* tags_;
  std::vector<std::uint32_t> slots_;  // open addressing, linear probing, at most half full
  std::size_t used_ = 0;
  std::unordered_map<std::string, std::size_t> odd_;
};

}  // namespace forager::mocks
