#include "flight/mavlink/sha256.hpp"

namespace forager::flight::mavlink {
namespace {

hal::Failure absent(const char* operation) {
  return hal::fail(hal::ErrorCode::unsupported, "MAVLink signing", operation, "built without libcrypto",
                   "install libssl-dev and build again, or leave the signing key out");
}

}  // namespace

struct Sha256::State {};

Sha256::Sha256(std::unique_ptr<State> state) : state_(std::move(state)) {}
Sha256::Sha256(Sha256&&) noexcept = default;
Sha256& Sha256::operator=(Sha256&&) noexcept = default;
Sha256::~Sha256() = default;

hal::Result<Sha256> Sha256::create() { return absent("set up SHA-256"); }

hal::Result<Sha256Digest> Sha256::digest(std::span<const std::byte> /*first*/,
                                         std::span<const std::byte> /*second*/) {
  return absent("compute SHA-256");
}

}  // namespace forager::flight::mavlink
