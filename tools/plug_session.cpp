#include "tools/plug_session.hpp"

#include <charconv>

#include "boards/run_clock.hpp"
#include "tools/cli_checks.hpp"

namespace forager::tools {

PlugSession::PlugSession(const PlugCommand& command)
    : plugs(command.emulated ? boards::emulated_plugs() : boards::real_plugs()),
      clock(command.emulated && !command.real_time ? boards::make_virtual_clock()
                                                   : boards::make_real_clock(1.0)),
      out(command.json),
      for_s(command.for_s) {}

std::optional<hal::Duration> PlugSession::time() const {
  return for_s > 0.0 ? std::optional(hal::from_seconds(for_s)) : std::nullopt;
}

std::string mistake_in(const PlugCommand& command) {
  if (command.watch && command.emulated && !command.real_time && !(command.for_s > 0.0))
    return "emulated devices are watched with --for, or with --real-time";
  return {};
}

std::optional<UsbId> usb_id_from(const std::string& text) {
  const auto hex = [](std::string_view digits, std::uint16_t& value) {
    const char* end = digits.data() + digits.size();
    const auto [stopped, error] = std::from_chars(digits.data(), end, value, 16);
    return error == std::errc() && stopped == end && digits.size() == 4;
  };
  UsbId id;
  if (text.size() != 9 || text[4] != ':') return std::nullopt;
  if (!hex(std::string_view(text).substr(0, 4), id.vendor) ||
      !hex(std::string_view(text).substr(5), id.product))
    return std::nullopt;
  return id;
}

void add_plug_options(CLI::App* sub, const std::shared_ptr<PlugCommand>& command) {
  sub->add_flag("--sim", command->emulated, "Devices emulated in this process, instead of this machine's");
  sub->add_flag("--json", command->json, "JSON lines on stdout");
  if (!command->watch) return;
  sub->add_option("--for", command->for_s, "Stop after so long, such as 10s; else at Ctrl-C")
      ->transform(TimeSpan(0.01, 1e6));
  sub->add_flag("--real-time", command->real_time, "Let emulated devices live by the clock too");
}

}  // namespace forager::tools
