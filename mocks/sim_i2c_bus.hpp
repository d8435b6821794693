#pragma once

#include <cstdint>
#include <map>
#include <optional>
#include <string>
#include <string_view>

#include "hal/i2c.hpp"
#include "hal/journal.hpp"
#include "hal/time.hpp"

namespace forager::mocks {

// A chip on an emulated bus, seen byte by byte as its pins see them.
class SimI2cDevice {
 public:
  virtual ~SimI2cDevice() = default;
  virtual void start() {}                       // START or repeated START with our address and the write bit
  virtual bool write(std::byte byte) = 0;       // false: not acknowledged
  virtual std::optional<std::byte> read() = 0;  // nothing: it refuses to be read now
  virtual void stop() {}
};

// An I2C bus in memory. An address without a chip is not acknowledged; nothing answers unless it was
// attached.
class SimI2cBus final : public hal::I2c {
 public:
  explicit SimI2cBus(std::string name, hal::Journal* journal = nullptr)
      : name_(std::move(name)), journal_(journal) {}

  void attach(std::uint8_t address, SimI2cDevice& device) { devices_[address] = &device; }
  void detach(std::uint8_t address) { devices_.erase(address); }
  void tick(hal::Instant now) { now_ = now; }
  void fail_next(hal::Error error) { next_error_ = std::move(error); }
  // The adapter is unplugged: everything answers disconnected.
  void disconnect(bool out = true) { disconnected_ = out; }
  [[nodiscard]] std::uint32_t transfers() const { return transfers_; }

 private:
  hal::Result<> do_transfer(std::uint8_t address, std::span<const std::byte> bytes,
                            std::span<std::byte> into) override;
  [[nodiscard]] std::string_view do_name() const override { return name_; }
  [[nodiscard]] hal::Failure fail(hal::ErrorCode code, std::uint8_t address, std::string why) const;

  std::string name_;
  hal::Journal* journal_;
  hal::Instant now_;
  std::map<std::uint8_t, SimI2cDevice*> devices_;
  bool disconnected_ = false;
  std::uint32_t transfers_ = 0;
  std::optional<hal::Error> next_error_;
};

}  // namespace forager::mocks
