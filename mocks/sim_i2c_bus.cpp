#include "mocks/sim_i2c_bus.hpp"

#include <fmt/format.h>

#include <utility>

namespace forager::mocks {

hal::Failure SimI2cBus::fail(hal::ErrorCode code, std::uint8_t address, std::string why) const {
  return hal::fail(code, name_, fmt::format("transfer with 0x{:02x}", address), std::move(why));
}

hal::Result<> SimI2cBus::do_transfer(std::uint8_t address, std::span<const std::byte> bytes,
                                     std::span<std::byte> into) {
  if (next_error_) return hal::fail(*std::exchange(next_error_, std::nullopt));
  if (disconnected_) return fail(hal::ErrorCode::disconnected, address, "the adapter is unplugged");
  const auto found = devices_.find(address);
  if (found == devices_.end())
    return fail(hal::ErrorCode::no_ack, address, "no chip answers at this address");
  ++transfers_;
  SimI2cDevice& chip = *found->second;
  if (journal_ != nullptr && !bytes.empty())
    journal_->wire(now_, fmt::format("{} 0x{:02x}", name_, address), "tx", bytes);
  chip.start();
  for (std::size_t i = 0; i < bytes.size(); ++i) {
    if (chip.write(bytes[i])) continue;
    chip.stop();
    return fail(hal::ErrorCode::no_ack, address, fmt::format("byte {} was not acknowledged", i + 1));
  }
  for (std::byte& byte : into) {
    const auto read = chip.read();
    if (!read) {
      chip.stop();
      return fail(hal::ErrorCode::no_ack, address, "the chip refuses to be read");
    }
    byte = *read;
  }
  chip.stop();
  return {};
}

}  // namespace forager::mocks
