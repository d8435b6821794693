// libgpiod 2 (Debian 13 and later, the v2 interface of kernels from 5.10 on). Twin: gpiod1_gpio.cpp.
#include <fmt/format.h>
#include <gpiod.h>
#include <unistd.h>

#include <algorithm>
#include <array>
#include <cerrno>

#include "hal/linux/gpio.hpp"
#include "hal/linux/gpio_error.hpp"
#include "hal/linux/gpio_request.hpp"
#include "hal/success.hpp"

namespace forager::hal {
namespace {

template <auto Free>
struct Delete {
  template <class T>
  void operator()(T* object) const {
    Free(object);
  }
};
using Chip = std::unique_ptr<gpiod_chip, Delete<gpiod_chip_close>>;
using ChipInfo = std::unique_ptr<gpiod_chip_info, Delete<gpiod_chip_info_free>>;
using LineInfo = std::unique_ptr<gpiod_line_info, Delete<gpiod_line_info_free>>;
using Settings = std::unique_ptr<gpiod_line_settings, Delete<gpiod_line_settings_free>>;
using LineConfig = std::unique_ptr<gpiod_line_config, Delete<gpiod_line_config_free>>;
using RequestConfig = std::unique_ptr<gpiod_request_config, Delete<gpiod_request_config_free>>;
using LineRequest = std::unique_ptr<gpiod_line_request, Delete<gpiod_line_request_release>>;
using EventBuffer = std::unique_ptr<gpiod_edge_event_buffer, Delete<gpiod_edge_event_buffer_free>>;

std::string text(const char* words) { return words == nullptr ? std::string() : std::string(words); }

// By path, by name, or by label.
Result<Chip> open_chip(const std::string& wanted, const std::string& device) {
  if (const std::string path = gpio_chip_path(wanted); !path.empty()) {
    Chip chip(gpiod_chip_open(path.c_str()));
    if (!chip) return gpio_failure(device, "open", errno);
    return chip;
  }
  int refused = ENOENT;
  for (int number = 0; number < kMostGpioChips; ++number) {
    if (access(gpio_chip_path(number).c_str(), F_OK) != 0) continue;
    Chip chip(gpiod_chip_open(gpio_chip_path(number).c_str()));
    const ChipInfo info(chip ? gpiod_chip_get_info(chip.get()) : nullptr);
    if (info && wanted == gpiod_chip_info_get_label(info.get())) return chip;
    if (!chip) refused = errno;  // the one that is wanted may be behind it
  }
  return gpio_failure(device, "open", refused);
}

Result<unsigned> find_line(gpiod_chip* chip, const GpioLineConfig& wanted) {
  const std::string device = gpio_name({wanted});
  const ChipInfo info(gpiod_chip_get_info(chip));
  if (!info) return gpio_failure(device, "open", errno);
  const std::size_t count = gpiod_chip_info_get_num_lines(info.get());
  return find_gpio_line(wanted, count, [&](unsigned offset) -> Result<std::string> {
    const LineInfo line(gpiod_chip_get_line_info(chip, offset));
    if (!line) return gpio_failure(device, "open", errno);
    return text(gpiod_line_info_get_name(line.get()));
  });
}

Settings settings_of(const GpioLineConfig& config, bool output) {
  Settings settings(gpiod_line_settings_new());
  if (!settings) return settings;
  gpiod_line_settings* raw = settings.get();
  gpiod_line_settings_set_direction(raw, output ? GPIOD_LINE_DIRECTION_OUTPUT : GPIOD_LINE_DIRECTION_INPUT);
  gpiod_line_settings_set_active_low(raw, config.active_low);
  gpiod_line_settings_set_output_value(
      raw, config.begin_active ? GPIOD_LINE_VALUE_ACTIVE : GPIOD_LINE_VALUE_INACTIVE);
  constexpr std::array kBias{GPIOD_LINE_BIAS_AS_IS, GPIOD_LINE_BIAS_DISABLED, GPIOD_LINE_BIAS_PULL_UP,
                             GPIOD_LINE_BIAS_PULL_DOWN};
  constexpr std::array kDrive{GPIOD_LINE_DRIVE_PUSH_PULL, GPIOD_LINE_DRIVE_OPEN_DRAIN,
                              GPIOD_LINE_DRIVE_OPEN_SOURCE};
  gpiod_line_settings_set_bias(raw, kBias.at(static_cast<std::size_t>(config.bias)));
  if (output) gpiod_line_settings_set_drive(raw, kDrive.at(static_cast<std::size_t>(config.drive)));
  if (!output && config.edges == GpioEdges::both) {
    gpiod_line_settings_set_edge_detection(raw, GPIOD_LINE_EDGE_BOTH);
    gpiod_line_settings_set_event_clock(raw, GPIOD_LINE_CLOCK_MONOTONIC);
  }
  gpiod_line_settings_set_debounce_period_us(
      raw, static_cast<unsigned long>(config.debounce / std::chrono::microseconds(1)));
  return settings;
}

// Lines of one chip, requested together.
struct Request {
  LineRequest lines;
  std::vector<unsigned> offsets;
  std::string name;
};

std::string holder_of(gpiod_chip* chip, const std::vector<unsigned>& offsets) {
  for (const unsigned offset : offsets) {
    const LineInfo info(gpiod_chip_get_line_info(chip, offset));
    if (info && gpiod_line_info_is_used(info.get())) return text(gpiod_line_info_get_consumer(info.get()));
  }
  return {};
}

Result<Request> request(const std::vector<GpioLineConfig>& configs, bool output) {
  const GpioLineConfig& first = configs.front();
  Request made;
  made.name = gpio_name(configs);
  const auto chip = open_chip(first.chip, made.name);
  if (!chip) return fail(chip.error());
  for (const GpioLineConfig& config : configs) {
    const auto line = find_line(chip->get(), config);
    if (!line) return fail(line.error());
    made.offsets.push_back(*line);
  }
  const Settings settings = settings_of(first, output);
  const LineConfig lines(gpiod_line_config_new());
  const RequestConfig how(gpiod_request_config_new());
  if (!settings || !lines || !how ||
      gpiod_line_config_add_line_settings(lines.get(), made.offsets.data(), made.offsets.size(),
                                          settings.get()) != 0)
    return gpio_failure(made.name, "open", errno);
  gpiod_request_config_set_consumer(how.get(), first.consumer.c_str());
  made.lines.reset(gpiod_chip_request_lines(chip->get(), how.get(), lines.get()));
  if (made.lines) return made;
  const int error = errno;
  return gpio_failure(made.name, "open", error, error == EBUSY ? holder_of(chip->get(), made.offsets) : "");
}

class Out final : public DigitalOut, public DigitalOutGroup {
 public:
  Out(Request request, GpioAtEnd at_end) : request_(std::move(request)), at_end_(at_end) {}
  ~Out() override {
    const std::array<bool, kMostGpioLines> inactive{};
    if (at_end_ == GpioAtEnd::inactive)
      static_cast<void>(do_set(std::span(inactive).first(request_.offsets.size())));
  }
  Out(const Out&) = delete;
  Out& operator=(const Out&) = delete;

 private:
  Result<> do_set(bool active) override {
    const auto value = active ? GPIOD_LINE_VALUE_ACTIVE : GPIOD_LINE_VALUE_INACTIVE;
    if (gpiod_line_request_set_value(request_.lines.get(), request_.offsets[0], value) != 0)
      return gpio_failure(request_.name, "set", errno);
    return success();
  }
  Result<> do_set(std::span<const bool> active) override {
    std::array<gpiod_line_value, kMostGpioLines> values{};
    std::transform(active.begin(), active.end(), values.begin(),
                   [](bool on) { return on ? GPIOD_LINE_VALUE_ACTIVE : GPIOD_LINE_VALUE_INACTIVE; });
    if (gpiod_line_request_set_values(request_.lines.get(), values.data()) != 0)
      return gpio_failure(request_.name, "set", errno);
    return success();
  }
  [[nodiscard]] std::size_t do_size() const override { return request_.offsets.size(); }
  [[nodiscard]] std::string_view do_name() const override { return request_.name; }

  Request request_;
  GpioAtEnd at_end_;
};

class In final : public EdgeIn {
 public:
  In(Request request, bool edges)
      : request_(std::move(request)), buffer_(edges ? gpiod_edge_event_buffer_new(1) : nullptr) {}

 private:
  Result<bool> do_active() override {
    const auto value = gpiod_line_request_get_value(request_.lines.get(), request_.offsets[0]);
    if (value == GPIOD_LINE_VALUE_ERROR) return gpio_failure(request_.name, "read", errno);
    return value == GPIOD_LINE_VALUE_ACTIVE;
  }
  Result<std::size_t> do_edges(std::span<Edge> into) override;
  std::string_view do_name() const override { return request_.name; }

  Request request_;
  EventBuffer buffer_;  // none: opened without edges
};

Result<std::size_t> In::do_edges(std::span<Edge> into) {
  if (!buffer_)
    return fail(ErrorCode::invalid_state, request_.name, "read edges", "it was opened without them");
  std::size_t count = 0;
  while (count < into.size()) {
    const int waiting = gpiod_line_request_wait_edge_events(request_.lines.get(), 0);
    if (waiting == 0) break;
    if (waiting < 0 || gpiod_line_request_read_edge_events(request_.lines.get(), buffer_.get(), 1) != 1)
      return gpio_failure(request_.name, "read edges", errno);
    gpiod_edge_event* event = gpiod_edge_event_buffer_get_event(buffer_.get(), 0);
    const auto ns = static_cast<std::int64_t>(gpiod_edge_event_get_timestamp_ns(event));
    into[count++] = {Instant(Duration(ns)),
                     gpiod_edge_event_get_event_type(event) == GPIOD_EDGE_EVENT_RISING_EDGE};
  }
  return count;
}

Result<std::unique_ptr<In>> open_in(const GpioLineConfig& config) {
  auto made = request({config}, false);
  if (!made) return fail(std::move(made).error());
  return std::make_unique<In>(*std::move(made), config.edges == GpioEdges::both);
}

}  // namespace

Result<std::unique_ptr<DigitalOut>> open_gpio_out(const GpioLineConfig& config) {
  auto made = request({config}, true);
  if (!made) return fail(std::move(made).error());
  return std::make_unique<Out>(*std::move(made), config.at_end);
}

Result<std::unique_ptr<DigitalOutGroup>> open_gpio_group(const std::vector<GpioLineConfig>& lines) {
  FORAGER_TRY(check_gpio_group(lines));
  auto made = request(lines, true);
  if (!made) return fail(std::move(made).error());
  return std::make_unique<Out>(*std::move(made), lines[0].at_end);
}

Result<std::unique_ptr<DigitalIn>> open_gpio_in(const GpioLineConfig& config) {
  return open_in(config).map([](auto in) -> std::unique_ptr<DigitalIn> { return in; });
}

Result<std::unique_ptr<EdgeIn>> open_gpio_edges(const GpioLineConfig& config) {
  FORAGER_TRY(check_gpio_edges(config));
  return open_in(config).map([](auto in) -> std::unique_ptr<EdgeIn> { return in; });
}

Result<std::vector<GpioLineFacts>> list_gpio() {
  std::vector<GpioLineFacts> facts;
  int refused = 0;
  for (int number = 0; number < kMostGpioChips; ++number) {
    if (access(gpio_chip_path(number).c_str(), F_OK) != 0) continue;
    const Chip chip(gpiod_chip_open(gpio_chip_path(number).c_str()));
    if (!chip) refused = errno;
    const ChipInfo about(chip ? gpiod_chip_get_info(chip.get()) : nullptr);
    for (unsigned offset = 0; about && offset < gpiod_chip_info_get_num_lines(about.get()); ++offset) {
      const LineInfo line(gpiod_chip_get_line_info(chip.get(), offset));
      if (!line) continue;
      facts.push_back(
          {gpiod_chip_info_get_name(about.get()), gpiod_chip_info_get_label(about.get()), offset,
           text(gpiod_line_info_get_name(line.get())),
           gpiod_line_info_is_used(line.get()) ? text(gpiod_line_info_get_consumer(line.get())) : "",
           gpiod_line_info_get_direction(line.get()) == GPIOD_LINE_DIRECTION_OUTPUT,
           gpiod_line_info_is_active_low(line.get())});
    }
  }
  if (facts.empty() && refused != 0) return gpio_failure("gpio", "list", refused);
  return facts;
}

std::string gpio_library() { return fmt::format("libgpiod {}", gpiod_api_version()); }

}  // namespace forager::hal
