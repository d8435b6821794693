#pragma once

#include <bit>
#include <cstddef>
#include <cstdint>
#include <span>
#include <utility>
#include <vector>

#include "reader/epc.hpp"

namespace forager::reader {

// Map from EPC to a small value, for the path that must not allocate. Entries lie dense in the order they
// came (so iteration is repeatable and a range of entries is "those since then"); an open-addressing index of
// 8-byte slots points at them, at most half full, linear probing. Nothing is ever erased. Allocates only
// when more than the reserved number of entries are stored; pointers hold until then.
template <class Value>
class EpcTable {
 public:
  struct Entry {
    Epc epc;
    Value value;
  };

  explicit EpcTable(std::size_t expected = 0) { reserve(expected); }

  void reserve(std::size_t expected) {
    entries_.reserve(expected);
    const std::size_t wanted = std::bit_ceil(2 * (expected < 8 ? 8 : expected));
    if (wanted > slots_.size()) rebuild(wanted);
  }

  [[nodiscard]] std::size_t size() const { return entries_.size(); }
  [[nodiscard]] std::span<Entry> entries() { return entries_; }
  [[nodiscard]] std::span<const Entry> entries() const { return entries_; }

  // nullptr if the EPC is not in the table.
  [[nodiscard]] Value* find(const Epc& epc) {
    const Slot& slot = slots_[position(epc, epc.hash())];
    return slot.entry == kEmpty ? nullptr : &entries_[slot.entry].value;
  }

  // The value of the EPC, stored now if it was not there yet; true if so.
  std::pair<Value*, bool> insert(const Epc& epc, const Value& value) {
    const std::uint64_t hash = epc.hash();
    std::size_t at = position(epc, hash);
    if (slots_[at].entry != kEmpty) return {&entries_[slots_[at].entry].value, false};
    if (2 * (entries_.size() + 1) > slots_.size()) {
      rebuild(2 * slots_.size());
      at = position(epc, hash);
    }
    slots_[at] = {static_cast<std::uint32_t>(entries_.size()), tag(hash)};
    entries_.push_back({epc, value});
    return {&entries_.back().value, true};
  }

 private:
  static constexpr std::uint32_t kEmpty = 0xFFFFFFFF;
  // The upper half of the hash rides along so that a probe seldom touches an entry that does not match.
  struct Slot {
    std::uint32_t entry = kEmpty;
    std::uint32_t tag = 0;
  };

  static std::uint32_t tag(std::uint64_t hash) { return static_cast<std::uint32_t>(hash >> 32); }

  // Where the EPC is, or the empty slot where it would go.
  std::size_t position(const Epc& epc, std::uint64_t hash) const {
    const std::size_t mask = slots_.size() - 1;
    std::size_t at = static_cast<std::size_t>(hash) & mask;
    while (slots_[at].entry != kEmpty &&
           (slots_[at].tag != tag(hash) || entries_[slots_[at].entry].epc != epc))
      at = (at + 1) & mask;
    return at;
  }

  void rebuild(std::size_t slot_count) {
    slots_.assign(slot_count, Slot{});
    for (std::size_t i = 0; i < entries_.size(); ++i) {
      const std::uint64_t hash = entries_[i].epc.hash();
      slots_[position(entries_[i].epc, hash)] = {static_cast<std::uint32_t>(i), tag(hash)};
    }
  }

  std::vector<Entry> entries_;
  std::vector<Slot> slots_;
};

}  // namespace forager::reader
