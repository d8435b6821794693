#pragma once

// Links that come and go, in virtual time: reader, autopilot on a datagram line, autopilot on a
// serial port, devices on Modbus.
#include <gtest/gtest.h>

#include <array>
#include <memory>
#include <string>

#include "flight/mavlink_autopilot.hpp"
#include "flight/motor_authority.hpp"
#include "hal/linux/serial_port.hpp"
#include "hal/random.hpp"
#include "mocks/fake_tag_field.hpp"
#include "mocks/mavlink_peer.hpp"
#include "mocks/memory_stream.hpp"
#include "mocks/sim_battery_gauge.hpp"
#include "mocks/sim_docking_charger.hpp"
#include "mocks/sim_http_client.hpp"
#include "mocks/sim_modbus_bus.hpp"
#include "mocks/sim_reader.hpp"
#include "mocks/virtual_clock.hpp"
#include "reader/advannet_reader.hpp"
#include "servo/modbus_battery.hpp"
#include "servo/modbus_charger.hpp"
#include "tests/hal/linux/fake_tty.hpp"
#include "tests/reader/advannet_rig.hpp"

namespace forager::boards::test_links {

using namespace std::chrono_literals;

// A link with somebody at its other end whom fate can take away.
class Link {
 public:
  virtual ~Link() = default;
  virtual void update(hal::Instant now) = 0;
  virtual void break_down(std::uint64_t kind, hal::Instant now) = 0;
  virtual void mend(hal::Instant now) = 0;
  // For the driver's owner.
  [[nodiscard]] virtual bool up(hal::Instant now) const = 0;
  [[nodiscard]] virtual std::string reason() const = 0;
  [[nodiscard]] virtual hal::Instant last_heard() const = 0;
  // Of the last fault: nothing at all can be heard any more.
  bool deaf = true;
  hal::Duration notices_within{};   // of a fault that takes everything away
  hal::Duration recovers_within{};  // after the mend
};

class ReaderLink final : public Link {
 public:
  ReaderLink() {
    sim_.streams().attach(wire_);
    driver_.start(hal::Instant{});
    notices_within = 10s + 2s;          // stream_timeout
    recovers_within = 60s + 15s + 20s;  // longest pause, boot, opening
  }
  void update(hal::Instant now) override {
    sim_.update(now);
    driver_.update(now);
  }
  void break_down(std::uint64_t kind, hal::Instant now) override {
    deaf = kind < 2;  // else REST goes on
    if (kind == 0) sim_.power_cut(now);
    if (kind == 1) sim_.faults().refuse_connects = true;
    if (kind == 1 || kind == 2) wire_.drop();
    if (kind >= 2) wire_.cut(true);
  }
  void mend(hal::Instant now) override {
    if (!sim_.powered()) sim_.power_on(now);
    sim_.faults().refuse_connects = false;
    wire_.cut(false);
  }
  [[nodiscard]] bool up(hal::Instant) const override { return driver_.link().reading(); }
  [[nodiscard]] std::string reason() const override { return driver_.link().reason; }
  [[nodiscard]] hal::Instant last_heard() const override { return driver_.link().last_heard; }

 private:
  hal::NullJournal journal_;
  mocks::FakeTagField field_;
  mocks::SimReader sim_{{}, field_, journal_};
  mocks::SimHttpClient http_{{"192.168.1.50:3161", 4ms, "admin", "admin"}, sim_};
  mocks::MemoryStreamPair wire_{"tcp 192.168.1.50:3177", mocks::MemoryStreamKind::bytes, 1U << 18U};
  reader::AdvanNetReader driver_{http_, wire_.near(), journal_, forager::test::rig_plan(),
                                 forager::test::rig_config()};
};

// A driver of MAVLink, whatever the line; notes keep the last failure it told of.
class MavlinkLinkBase : public Link {
 public:
  explicit MavlinkLinkBase(hal::ByteStream& line) {
    driver_ =
        flight::MavlinkAutopilot::create(line, journal_, {}, hal::Instant{}, *bay_.claim("flapping")).value();
    notices_within = 3s + 1s;         // link_timeout
    recovers_within = 10s + 4s + 2s;  // reopen_after_silence, reopen_most, a heartbeat
  }
  [[nodiscard]] bool up(hal::Instant) const override { return driver_->state().link_up; }
  [[nodiscard]] std::string reason() const override { return journal_.last; }
  [[nodiscard]] hal::Instant last_heard() const override { return driver_->state().last_heartbeat; }

 protected:
  void drive(hal::Instant now) {
    driver_->feed_deadman(now);
    driver_->update(now);
  }
  std::span<const std::byte> heartbeat(hal::Instant now) {
    if (now < next_beat_) return {};
    next_beat_ = now + 1s;
    mocks::MavlinkPayload p;
    p.put<std::uint8_t>(4, 13);
    p.put<std::uint8_t>(5, 3);
    p.put<std::uint8_t>(6, 1);
    p.put<std::uint8_t>(7, 4);
    p.put<std::uint8_t>(8, 3);
    return packer_.pack(mocks::peer::kHeartbeat, p);
  }

 private:
  class LastFailure final : public hal::Journal {
   public:
    std::string last;

   private:
    void do_note(hal::Instant, std::string_view, std::string_view text) override {
      if (text.find("fail") != std::string_view::npos || text.find("lost") != std::string_view::npos)
        last = text;
    }
    void do_wire(hal::Instant, std::string_view, std::string_view, std::span<const std::byte>) override {}
  };
  LastFailure journal_;
  flight::MotorBay bay_;
  std::unique_ptr<flight::MavlinkAutopilot> driver_;
  mocks::MavlinkPeerPacker packer_{1, 1};
  hal::Instant next_beat_;
};

struct DatagramLine {
  mocks::MemoryStreamPair pair{"udp autopilot", mocks::MemoryStreamKind::datagrams};
};

class DatagramLink final : private DatagramLine, public MavlinkLinkBase {
 public:
  DatagramLink() : MavlinkLinkBase(pair.near()) {}
  void update(hal::Instant now) override {
    static_cast<void>(pair.far().poll());
    if (pair.far().state() == hal::StreamState::closed) static_cast<void>(pair.far().open());
    if (const auto beat = heartbeat(now); !beat.empty()) static_cast<void>(pair.far().write(beat));
    std::array<std::byte, 512> heard{};
    for (int i = 0; i < 64 && pair.far().read(heard).value_or(0) > 0; ++i) {
    }
    drive(now);
  }
  void break_down(std::uint64_t kind, hal::Instant) override {
    pair.cut(true);
    if (kind == 0)
      pair.near().fail_next({hal::ErrorCode::disconnected, "udp autopilot", "read", "network down", "", 0});
  }
  void mend(hal::Instant) override { pair.cut(false); }
};

// The adapter is pulled out, comes back under the same name, and belongs to root until udev has run.
struct SerialLine {
  SerialLine() { plug(false); }
  void plug(bool to_root) {
    tty = std::make_shared<hal::fake::FakeTty>();
    if (to_root) tty->open_errno = EACCES;
    kernel.files["/dev/ttyACM0"] = tty;
  }
  hal::fake::FakeKernel kernel;
  mocks::VirtualClock clock;
  std::shared_ptr<hal::fake::FakeTty> tty;
  std::unique_ptr<hal::SerialPort> port = hal::open_serial_port({.device = "/dev/ttyACM0"}, clock, kernel);
};

class SerialLink final : private SerialLine, public MavlinkLinkBase {
 public:
  SerialLink() : MavlinkLinkBase(*port) {}
  void update(hal::Instant now) override {
    clock.advance(now - clock.now());
    if (permitted_at_ && now >= *permitted_at_) {
      tty->open_errno = 0;
      permitted_at_.reset();
    }
    const auto beat = heartbeat(now);
    if (!silent_)
      for (const std::byte byte : beat) tty->incoming += static_cast<char>(byte);
    drive(now);
    kernel.writes.clear();
    ASSERT_LE(kernel.open_files(), 1U);
  }
  void break_down(std::uint64_t kind, hal::Instant) override {
    silent_ = kind > 1;  // the autopilot is off, the adapter is still there
    if (silent_) return;
    tty->unplugged = true;
    kernel.files.erase("/dev/ttyACM0");
  }
  void mend(hal::Instant now) override {
    if (!std::exchange(silent_, false)) {
      plug(true);
      permitted_at_ = now + 300ms;
    }
  }

 private:
  bool silent_ = false;
  std::optional<hal::Instant> permitted_at_;
};

class ModbusLink final : public Link {
 public:
  ModbusLink() {
    bus_.attach(gauge_.slave());
    bus_.attach(dock_.slave());
    dock_.docked = true;
    notices_within = 5s + 1s;  // stale_after
    recovers_within = 2s;      // two polls
  }
  void update(hal::Instant now) override {
    gauge_.update(now);
    dock_.update(now);
    charger_.charge_until(now + 500ms);
    for (const auto& updated : {battery_.update(now), charger_.update(now)}) {
      if (updated) continue;
      last_ = updated.error();
      const hal::ErrorCode wanted[] = {hal::ErrorCode::disconnected, hal::ErrorCode::timeout,
                                       hal::ErrorCode::protocol};
      ASSERT_EQ(wanted[kind_], last_.code) << describe(last_);
    }
    ASSERT_EQ(battery_.stale(now), !battery_.reading() || now - battery_.reading()->at > 5s);
  }
  void break_down(std::uint64_t kind, hal::Instant) override {
    kind_ = kind % 3;
    bus_.unplug(kind_ == 0);
    set_fault(kind_ == 1   ? mocks::SimModbusSlave::Fault::silent
              : kind_ == 2 ? mocks::SimModbusSlave::Fault::wrong_crc
                           : mocks::SimModbusSlave::Fault::none);
  }
  void mend(hal::Instant) override {
    bus_.unplug(false);
    set_fault(mocks::SimModbusSlave::Fault::none);
  }
  [[nodiscard]] bool up(hal::Instant now) const override { return !battery_.stale(now); }
  [[nodiscard]] std::string reason() const override { return describe(last_); }
  [[nodiscard]] hal::Instant last_heard() const override {
    return battery_.reading() ? battery_.reading()->at : hal::Instant{};
  }

 private:
  static servo::ModbusRegister input(const char* name, std::uint16_t address, servo::RegisterType type,
                                     double scale) {
    return {
        .name = name, .address = address, .table = servo::RegisterTable::input, .type = type, .scale = scale};
  }
  void set_fault(mocks::SimModbusSlave::Fault fault) { gauge_.slave().fault = dock_.slave().fault = fault; }

  mocks::SimModbusBus bus_;
  mocks::SimBatteryGauge gauge_;
  mocks::SimDockingCharger dock_;
  servo::ModbusBattery battery_ =
      servo::ModbusBattery::create(bus_, {.unit = 4,
                                          .voltage = input("voltage", 0, servo::RegisterType::u16, 0.01),
                                          .charge = input("charge", 10, servo::RegisterType::f32, 0.01)})
          .value();
  servo::ModbusCharger charger_ =
      servo::ModbusCharger::create(bus_,
                                   {.unit = 5, .status = input("status", 0, servo::RegisterType::u16, 1.0)})
          .value();
  hal::Error last_{};
  std::size_t kind_ = 0;
};

}  // namespace forager::boards::test_links
