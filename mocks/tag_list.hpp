#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <string>
#include <string_view>
#include <unordered_map>
#include <vector>

#include "hal/pose.hpp"
#include "mocks/tag_grid.hpp"

namespace forager::mocks {

// A tag as it is put into a world.
struct Tag {
  std::string epc_hex;  // lower case
  hal::Vec3 position;
  bool wanted = true;  // false: a bystander that belongs to nobody's inventory
};

// The bytes of a 96-bit EPC.
using Epc96 = std::array<std::uint8_t, 12>;

// For hash tables; all bytes count, for those of one shop differ in the last few only.
struct HashOfEpc96 {
  [[nodiscard]] std::size_t operator()(const Epc96& epc) const;
};

// 24 lower-case hexadecimal digits.
void append_hex(std::string& out, const Epc96& epc);

// The tags of a world, ten million of them in 400 MB: 37 bytes each, coordinates axis by axis. EPCs that are
// not 96 bits long cost a string each.
class TagList {
 public:
  struct View {
    hal::Vec3 position;
    bool wanted = true;
  };

  [[nodiscard]] std::size_t size() const { return x_.size(); }
  [[nodiscard]] bool empty() const { return x_.empty(); }
  void reserve(std::size_t tags);
  void clear() { *this = TagList(); }

  // Any text is taken for an EPC. At most 2^32 - 2 tags.
  void push_back(const Tag& tag);
  void add(const Epc96& epc, hal::Vec3 position, bool wanted);
  // All tags of another list.
  friend void append(TagList& tags, const TagList& more);

  [[nodiscard]] View operator[](std::size_t tag) const { return {position(tag), wanted(tag)}; }
  [[nodiscard]] hal::Vec3 position(std::size_t tag) const { return {x_[tag], y_[tag], z_[tag]}; }
  [[nodiscard]] bool wanted(std::size_t tag) const { return wanted_[tag] != 0; }
  // Lower-case hexadecimal.
  void append_epc_hex(std::size_t tag, std::string& out) const;
  [[nodiscard]] std::string epc_hex(std::size_t tag) const;
  // Null: the EPC is not 96 bits long.
  [[nodiscard]] const Epc96* epc96(std::size_t tag) const {
    return odd_.empty() || !odd_.contains(tag) ? &epc_[tag] : nullptr;
  }
  [[nodiscard]] PointSpans points() const { return {x_, y_, z_}; }

 private:
  std::vector<double> x_;
  std::vector<double> y_;
  std::vector<double> z_;
  std::vector<Epc96> epc_;
  std::vector<std::uint8_t> wanted_;
  std::unordered_map<std::size_t, std::string> odd_;
};

}  // namespace forager::mocks
