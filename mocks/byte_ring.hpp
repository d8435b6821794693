#pragma once

#include <algorithm>
#include <cstddef>
#include <cstring>
#include <span>
#include <vector>

namespace forager::mocks {

// First in, first out bytes in a buffer of fixed size: allocates once, at construction.
class ByteRing {
 public:
  explicit ByteRing(std::size_t capacity) : bytes_(capacity) {}

  [[nodiscard]] std::size_t size() const { return size_; }
  [[nodiscard]] std::size_t room() const { return bytes_.size() - size_; }
  void clear() { head_ = size_ = 0; }

  // Takes as many bytes as fit and says how many.
  std::size_t push(std::span<const std::byte> from) {
    const std::size_t count = std::min(from.size(), room());
    if (count == 0) return 0;
    const std::size_t tail = (head_ + size_) % bytes_.size();
    const std::size_t first = std::min(count, bytes_.size() - tail);
    std::memcpy(bytes_.data() + tail, from.data(), first);
    std::memcpy(bytes_.data(), from.data() + first, count - first);
    size_ += count;
    return count;
  }

  // Hands out as many bytes as there are and the span holds, and says how many.
  std::size_t pop(std::span<std::byte> into) {
    const std::size_t count = std::min(into.size(), size_);
    if (count == 0) return 0;
    const std::size_t first = std::min(count, bytes_.size() - head_);
    std::memcpy(into.data(), bytes_.data() + head_, first);
    std::memcpy(into.data() + first, bytes_.data(), count - first);
    skip(count);
    return count;
  }

  void skip(std::size_t count) {
    count = std::min(count, size_);
    size_ -= count;
    head_ = size_ == 0 ? 0 : (head_ + count) % bytes_.size();
  }

 private:
  std::vector<std::byte> bytes_;
  std::size_t head_ = 0;
  std::size_t size_ = 0;
};

}  // namespace forager::mocks
