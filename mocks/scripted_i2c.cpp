#include "mocks/scripted_i2c.hpp"

#include <fmt/format.h>

#include <cstdlib>
#include <utility>

namespace forager::mocks {

ScriptedI2c::ScriptedI2c(ScriptFailure on_failure) : on_failure_(std::move(on_failure)) {}

ScriptedI2c::~ScriptedI2c() {
  if (!script_.empty())
    on_failure_(fmt::format("scripted i2c: {} transfers never came, the next is {}", script_.size(),
                            script_.front()));
}

ScriptedI2c& ScriptedI2c::expect(std::string_view transfer) {
  script_.emplace_back(transfer);
  return *this;
}

hal::Result<> ScriptedI2c::do_transfer(std::uint8_t address, std::span<const std::byte> bytes,
                                       std::span<std::byte> into) {
  std::string got = fmt::format("{:02x}", address);
  if (!bytes.empty()) got += " w";
  for (const std::byte byte : bytes) got += fmt::format(" {:02x}", std::to_integer<unsigned>(byte));
  if (!into.empty()) got += " r";
  const std::string wanted = script_.empty() ? "nothing" : script_.front();
  const bool same = wanted.compare(0, got.size(), got) == 0 && wanted.size() == got.size() + 3 * into.size();
  if (!same) {
    on_failure_(
        fmt::format("scripted i2c: came {} with {} bytes to read, expected {}", got, into.size(), wanted));
    return hal::fail(hal::ErrorCode::no_ack, "scripted i2c", got, "not in the script");
  }
  for (std::size_t i = 0; i < into.size(); ++i)
    into[i] = static_cast<std::byte>(std::strtoul(wanted.c_str() + got.size() + 3 * i, nullptr, 16));
  script_.pop_front();
  return {};
}

}  // namespace forager::mocks
