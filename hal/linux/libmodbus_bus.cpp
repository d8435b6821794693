// libmodbus 3.1. Twin: absent_libmodbus_bus.cpp.
#include <fmt/format.h>
#include <modbus/modbus.h>
#include <sys/ioctl.h>

#include <algorithm>
#include <cerrno>
#include <optional>
#include <utility>

#include "hal/linux/kernel.hpp"
#include "hal/linux/modbus_bus.hpp"
#include "hal/success.hpp"

namespace forager::hal {
namespace {

struct FreeContext {
  void operator()(modbus_t* context) const {
    modbus_close(context);
    modbus_free(context);
  }
};
using Context = std::unique_ptr<modbus_t, FreeContext>;

class LibmodbusBus final : public Modbus {
 public:
  LibmodbusBus(Context context, std::string name, Duration timeout)
      : context_(std::move(context)), name_(std::move(name)), timeout_(timeout) {}

 private:
  Result<> do_read(Table table, std::uint8_t unit, std::uint16_t address,
                   std::span<std::uint16_t> into) override {
    FORAGER_TRY(ready(unit));
    const auto read = table == Table::holding ? modbus_read_registers : modbus_read_input_registers;
    return judge(read(context_.get(), address, static_cast<int>(into.size()), into.data()), [&] {
      return fmt::format("read registers {} to {} of unit {}", address, address + into.size() - 1, unit);
    });
  }
  Result<> do_write(std::uint8_t unit, std::uint16_t address,
                    std::span<const std::uint16_t> values) override {
    FORAGER_TRY(ready(unit));
    const int answer =
        values.size() == 1
            ? modbus_write_register(context_.get(), address, values[0])
            : modbus_write_registers(context_.get(), address, static_cast<int>(values.size()), values.data());
    return judge(answer, [&] {
      return fmt::format("write registers {} to {} of unit {}", address, address + values.size() - 1, unit);
    });
  }
  Result<> do_write_coil(std::uint8_t unit, std::uint16_t address, bool on) override {
    FORAGER_TRY(ready(unit));
    return judge(modbus_write_bit(context_.get(), address, on ? 1 : 0),
                 [&] { return fmt::format("write coil {} of unit {}", address, unit); });
  }
  [[nodiscard]] std::string_view do_name() const override { return name_; }

  Result<> ready(std::uint8_t unit);
  void hear_late_answer();
  [[nodiscard]] Failure silence(std::string operation);
  // What was done is put into words when it failed only: that takes as long as all the rest of a call here.
  template <class Operation>
  Result<> judge(int answer, const Operation& operation) {
    if (answer < 0) {
      const int error = errno;
      return failed(error, operation());
    }
    if (late_unit_ == unit_) late_unit_.reset();
    return success();
  }
  [[nodiscard]] Failure failed(int error, std::string operation);

  Context context_;
  std::string name_;
  Duration timeout_;
  std::uint8_t unit_ = 0;
  std::optional<std::uint8_t> silent_unit_;  // whose answer did not come in time
  std::optional<std::uint8_t> late_unit_;    // whose answer was there when the next question was asked
  bool connected_ = false;
};

// An answer that came too late must not be taken for that to the next question: on a serial line nothing in
// it would tell. That it came at all is worth knowing.
void LibmodbusBus::hear_late_answer() {
  if (!silent_unit_) return;
  int waiting = 0;
  if (::ioctl(modbus_get_socket(context_.get()), FIONREAD, &waiting) == 0 && waiting > 0)
    late_unit_ = silent_unit_;
  silent_unit_.reset();
  modbus_flush(context_.get());
}

Failure LibmodbusBus::silence(std::string operation) {
  silent_unit_ = unit_;
  if (late_unit_ == unit_)
    return fail(ErrorCode::timeout, name_, std::move(operation),
                fmt::format("the answer comes, but later than the {} ms it is waited for",
                            timeout_ / std::chrono::milliseconds(1)),
                "Raise timeout_ms of the board file above what the device needs");
  return fail(ErrorCode::timeout, name_, std::move(operation), "no answer",
              "Check the unit's number, baud rate, power and wires A and B");
}

Result<> LibmodbusBus::ready(std::uint8_t unit) {
  unit_ = unit;
  modbus_set_slave(context_.get(), unit);
  if (connected_) hear_late_answer();
  if (connected_) return success();
  if (modbus_connect(context_.get()) == 0) {
    connected_ = true;
    return {};
  }
  const int error = errno;
  const ErrorCode code = error == ECONNREFUSED ? ErrorCode::refused : code_of_device_errno(error);
  const std::string_view why = code == ErrorCode::not_present  ? "there is no such port"
                               : code == ErrorCode::permission ? "the operating system forbids it"
                                                               : to_string(code);
  return fail(code, name_, "connect", std::string(why),
              code == ErrorCode::permission ? "Join the group dialout, and log in again"
                                            : "Check the port's name, the cable and the device's power",
              error);
}

Failure LibmodbusBus::failed(int error, std::string operation) {
  if (error > MODBUS_ENOBASE && error < MODBUS_ENOBASE + MODBUS_EXCEPTION_MAX)
    return modbus_exception(name_, operation, static_cast<std::uint8_t>(error - MODBUS_ENOBASE));
  modbus_flush(context_.get());  // what is left of a late or broken answer must not be taken for the next one
  const auto broken = [&](ErrorCode code, std::string detail, std::string mend) {
    return fail(code, name_, std::move(operation), std::move(detail), std::move(mend));
  };
  switch (error) {
    case ETIMEDOUT:
      return silence(std::move(operation));
    case EMBBADCRC:
      return broken(ErrorCode::protocol, "the answer's CRC is wrong",
                    "Check shielding, termination and parity");
    case EMBBADSLAVE:
      return broken(ErrorCode::protocol, "another unit answered", "Two devices may have the same number");
    case EMBBADDATA:
    case EMBBADEXC:
    case EMBMDATA:
    case EMBUNKEXC:
      return broken(ErrorCode::protocol, "the answer does not fit the question", "");
    default:
      break;
  }
  modbus_close(context_.get());
  connected_ = false;
  return fail(ErrorCode::disconnected, name_, std::move(operation), "the line is gone", "Check the cable",
              error);
}

Result<std::unique_ptr<Modbus>> make(modbus_t* raw, std::string name, Duration timeout) {
  Context context(raw);
  if (!context || timeout <= Duration::zero())
    return fail(ErrorCode::invalid_argument, std::move(name), "open", "settings that no line can have");
  const auto us = static_cast<std::uint32_t>(
      std::min<std::int64_t>(timeout / std::chrono::microseconds(1), 3'600'000'000));
  modbus_set_response_timeout(context.get(), us / 1'000'000, us % 1'000'000);
  modbus_set_byte_timeout(context.get(), us / 1'000'000, us % 1'000'000);
  return std::make_unique<LibmodbusBus>(std::move(context), std::move(name), timeout);
}

}  // namespace

Result<std::unique_ptr<Modbus>> open_modbus_rtu(const ModbusRtuConfig& config) {
  return make(modbus_new_rtu(config.device.c_str(), config.baud, config.parity, 8, config.stop_bits),
              "modbus " + config.device, config.timeout);
}

Result<std::unique_ptr<Modbus>> open_modbus_tcp(const ModbusTcpConfig& config) {
  return make(modbus_new_tcp(config.host.c_str(), config.port),
              fmt::format("modbus {}:{}", config.host, config.port), config.timeout);
}

std::string modbus_library() { return "libmodbus " LIBMODBUS_VERSION_STRING; }

}  // namespace forager::hal
