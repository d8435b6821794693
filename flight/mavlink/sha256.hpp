#pragma once

#include <array>
#include <cstddef>
#include <memory>
#include <span>

#include "hal/error.hpp"

namespace forager::flight::mavlink {

using Sha256Digest = std::array<std::byte, 32>;

// SHA-256 (FIPS 180-4) of two pieces of bytes in a row. Keeps its working state, so that one use after
// another allocates nothing.
class Sha256 {
 public:
  // Errors: unsupported (built without libcrypto), io (the library failed to set up).
  [[nodiscard]] static hal::Result<Sha256> create();
  Sha256(Sha256&&) noexcept;
  Sha256& operator=(Sha256&&) noexcept;
  ~Sha256();

  // Errors: io (the library failed).
  [[nodiscard]] hal::Result<Sha256Digest> digest(std::span<const std::byte> first,
                                                 std::span<const std::byte> second);

 private:
  struct State;
  explicit Sha256(std::unique_ptr<State> state);
  std::unique_ptr<State> state_;
};

}  // namespace forager::flight::mavlink
