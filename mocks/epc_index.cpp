#include "mocks/epc_index.hpp"

namespace forager::mocks {

EpcIndex::EpcIndex(const TagList& tags) : tags_(&tags), slots_(1024, kEmpty) {
  for (std::size_t tag = 0; tag < tags.size(); ++tag) static_cast<void>(add(tag));
}

// Where the EPC is, or the empty slot where it would go.
std::size_t EpcIndex::place_of(const Epc96& epc) const {
  const std::size_t mask = slots_.size() - 1;
  std::size_t at = HashOfEpc96{}(epc)&mask;
  while (slots_[at] != kEmpty && *tags_->epc96(slots_[at]) != epc) at = (at + 1) & mask;
  return at;
}

void EpcIndex::grow() {
  std::vector<std::uint32_t> old(2 * slots_.size(), kEmpty);
  old.swap(slots_);
  for (const std::uint32_t tag : old)
    if (tag != kEmpty) slots_[place_of(*tags_->epc96(tag))] = tag;
}

std::optional<std::size_t> EpcIndex::add(std::size_t tag) {
  const Epc96* const epc = tags_->epc96(tag);
  if (epc == nullptr) {
    const auto [at, is_new] = odd_.emplace(tags_->epc_hex(tag), tag);
    return is_new ? std::nullopt : std::optional(at->second);
  }
  if (2 * (used_ + 1) > slots_.size()) grow();
  const std::size_t at = place_of(*epc);
  if (slots_[at] != kEmpty) return slots_[at];
  slots_[at] = static_cast<std::uint32_t>(tag);
  ++used_;
  return std::nullopt;
}

}  // namespace forager::mocks
