#include <openssl/evp.h>

#include "flight/mavlink/sha256.hpp"

namespace forager::flight::mavlink {

struct Sha256::State {
  EVP_MD_CTX* context = EVP_MD_CTX_new();
  State() = default;
  State(const State&) = delete;
  State& operator=(const State&) = delete;
  ~State() { EVP_MD_CTX_free(context); }
};

Sha256::Sha256(std::unique_ptr<State> state) : state_(std::move(state)) {}
Sha256::Sha256(Sha256&&) noexcept = default;
Sha256& Sha256::operator=(Sha256&&) noexcept = default;
Sha256::~Sha256() = default;

hal::Result<Sha256> Sha256::create() {
  auto state = std::make_unique<State>();
  if (state->context == nullptr || EVP_DigestInit_ex(state->context, EVP_sha256(), nullptr) != 1)
    return hal::fail(hal::ErrorCode::io, "libcrypto", "set up SHA-256", "the library refused");
  return Sha256(std::move(state));
}

hal::Result<Sha256Digest> Sha256::digest(std::span<const std::byte> first,
                                         std::span<const std::byte> second) {
  EVP_MD_CTX* const context = state_->context;
  Sha256Digest digest{};
  unsigned size = 0;
  // A null digest type keeps the one set at creation and only starts over, without allocating.
  const bool good = EVP_DigestInit_ex(context, nullptr, nullptr) == 1 &&
                    EVP_DigestUpdate(context, first.data(), first.size()) == 1 &&
                    EVP_DigestUpdate(context, second.data(), second.size()) == 1 &&
                    EVP_DigestFinal_ex(context, reinterpret_cast<unsigned char*>(digest.data()), &size) == 1;
  if (!good) return hal::fail(hal::ErrorCode::io, "libcrypto", "compute SHA-256", "the library failed");
  return digest;
}

}  // namespace forager::flight::mavlink
