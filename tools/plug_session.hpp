#pragma once

#include <CLI/CLI.hpp>
#include <memory>
#include <optional>
#include <string>

#include "boards/plug_bench.hpp"
#include "hal/time.hpp"
#include "tools/bench_session.hpp"

// What `forager usb` and `forager hid` share.
namespace forager::tools {

struct PlugCommand {
  bool watch = false;
  bool emulated = false;
  bool real_time = false;
  bool json = false;
  bool exclusive = false;  // hid
  double for_s = 0.0;
  std::string device;  // VID:PID, a path, a name of the board file, or empty
  std::string board;   // hid: file whose names count; empty: none
};

// The devices, the clock and the output of such a command.
struct PlugSession {
  explicit PlugSession(const PlugCommand& command);

  [[nodiscard]] std::optional<hal::Duration> time() const;

  std::unique_ptr<boards::PlugBench> plugs;
  std::unique_ptr<hal::Clock> clock;
  BenchOutput out;
  double for_s;
};

// Empty, or what is wrong with the command.
[[nodiscard]] std::string mistake_in(const PlugCommand& command);

// "04d8:00dd". Nothing: not of that form.
struct UsbId {
  std::uint16_t vendor = 0;
  std::uint16_t product = 0;
};
[[nodiscard]] std::optional<UsbId> usb_id_from(const std::string& text);

void add_plug_options(CLI::App* sub, const std::shared_ptr<PlugCommand>& command);

}  // namespace forager::tools
