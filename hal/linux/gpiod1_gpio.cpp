// libgpiod 1.6 (Debian 12, Raspberry Pi OS 12, the v1 interface of kernels from 4.8 on). Twin:
// gpiod2_gpio.cpp.
#include <fmt/format.h>
#include <gpiod.h>
#include <unistd.h>

#include <algorithm>
#include <array>
#include <cerrno>
#include <ctime>
#include <optional>

#include "hal/linux/gpio.hpp"
#include "hal/linux/gpio_error.hpp"
#include "hal/linux/gpio_request.hpp"
#include "hal/success.hpp"

namespace forager::hal {
namespace {

struct CloseChip {
  void operator()(gpiod_chip* chip) const { gpiod_chip_close(chip); }  // gives its lines back, too
};
using Chip = std::unique_ptr<gpiod_chip, CloseChip>;

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
    if (chip && wanted == gpiod_chip_label(chip.get())) return chip;
    if (!chip) refused = errno;  // the one that is wanted may be behind it
  }
  return gpio_failure(device, "open", refused);
}

Result<gpiod_line*> find_line(gpiod_chip* chip, const GpioLineConfig& wanted) {
  const std::string device = gpio_name({wanted});
  const auto offset =
      find_gpio_line(wanted, gpiod_chip_num_lines(chip), [&](unsigned i) -> Result<std::string> {
        gpiod_line* line = gpiod_chip_get_line(chip, i);
        if (line == nullptr) return gpio_failure(device, "open", errno);
        const char* name = gpiod_line_name(line);
        return std::string(name == nullptr ? "" : name);
      });
  if (!offset) return fail(offset.error());
  gpiod_line* line = gpiod_chip_get_line(chip, *offset);
  if (line == nullptr) return gpio_failure(device, "open", errno);
  return line;
}

int flags_of(const GpioLineConfig& config) {
  int flags = 0;
  if (config.active_low) flags |= GPIOD_LINE_REQUEST_FLAG_ACTIVE_LOW;
  if (config.drive == GpioDrive::open_drain) flags |= GPIOD_LINE_REQUEST_FLAG_OPEN_DRAIN;
  if (config.drive == GpioDrive::open_source) flags |= GPIOD_LINE_REQUEST_FLAG_OPEN_SOURCE;
  if (config.bias == GpioBias::none) flags |= GPIOD_LINE_REQUEST_FLAG_BIAS_DISABLE;
  if (config.bias == GpioBias::pull_up) flags |= GPIOD_LINE_REQUEST_FLAG_BIAS_PULL_UP;
  if (config.bias == GpioBias::pull_down) flags |= GPIOD_LINE_REQUEST_FLAG_BIAS_PULL_DOWN;
  return flags;
}

static_assert(kMostGpioLines <= GPIOD_LINE_BULK_MAX_LINES);

// Lines of one chip, requested together.
struct Request {
  Chip chip;
  gpiod_line_bulk lines = GPIOD_LINE_BULK_INITIALIZER;
  std::string name;
};

Result<Request> request(const std::vector<GpioLineConfig>& configs, int type) {
  const GpioLineConfig& first = configs.front();
  Request made;
  made.name = gpio_name(configs);
  if (first.debounce > Duration::zero())
    return fail(ErrorCode::unsupported, made.name, "open", "libgpiod 1 cannot debounce",
                "Leave debounce_ms out, or build with libgpiod 2");
  auto chip = open_chip(first.chip, made.name);
  if (!chip) return fail(std::move(chip).error());
  made.chip = *std::move(chip);
  for (const GpioLineConfig& config : configs) {
    const auto line = find_line(made.chip.get(), config);
    if (!line) return fail(line.error());
    gpiod_line_bulk_add(&made.lines, *line);
  }
  const gpiod_line_request_config how{first.consumer.c_str(), type, flags_of(first)};
  std::array<int, GPIOD_LINE_BULK_MAX_LINES> levels{};
  levels.fill(first.begin_active ? 1 : 0);
  if (gpiod_line_request_bulk(&made.lines, &how, levels.data()) == 0) return made;
  const int error = errno;
  for (unsigned i = 0; i < gpiod_line_bulk_num_lines(&made.lines); ++i) {
    gpiod_line* line = gpiod_line_bulk_get_line(&made.lines, i);
    if (error != EBUSY || gpiod_line_update(line) != 0 || !gpiod_line_is_used(line)) continue;
    const char* consumer = gpiod_line_consumer(line);
    return gpio_failure(gpio_name({configs[i]}), "open", error, consumer == nullptr ? "" : consumer);
  }
  return gpio_failure(made.name, "open", error);
}

class Out final : public DigitalOut {
 public:
  Out(Request request, GpioAtEnd at_end)
      : request_(std::move(request)), line_(gpiod_line_bulk_get_line(&request_.lines, 0)), at_end_(at_end) {}
  ~Out() override {
    if (at_end_ == GpioAtEnd::inactive) gpiod_line_set_value(line_, 0);
  }
  Out(const Out&) = delete;
  Out& operator=(const Out&) = delete;

 private:
  Result<> do_set(bool active) override {
    if (gpiod_line_set_value(line_, active ? 1 : 0) != 0) return gpio_failure(request_.name, "set", errno);
    return success();
  }
  std::string_view do_name() const override { return request_.name; }

  Request request_;
  gpiod_line* line_;
  GpioAtEnd at_end_;
};

class Group final : public DigitalOutGroup {
 public:
  Group(Request request, GpioAtEnd at_end) : request_(std::move(request)), at_end_(at_end) {}
  ~Group() override {
    const std::array<int, GPIOD_LINE_BULK_MAX_LINES> inactive{};
    if (at_end_ == GpioAtEnd::inactive) gpiod_line_set_value_bulk(&request_.lines, inactive.data());
  }
  Group(const Group&) = delete;
  Group& operator=(const Group&) = delete;

 private:
  Result<> do_set(std::span<const bool> active) override {
    std::array<int, GPIOD_LINE_BULK_MAX_LINES> values{};
    std::copy(active.begin(), active.end(), values.begin());
    if (gpiod_line_set_value_bulk(&request_.lines, values.data()) != 0)
      return gpio_failure(request_.name, "set", errno);
    return success();
  }
  [[nodiscard]] std::size_t do_size() const override { return request_.lines.num_lines; }
  [[nodiscard]] std::string_view do_name() const override { return request_.name; }

  Request request_;
  GpioAtEnd at_end_;
};

// Kernels before 5.7 stamp events with the wall clock, later ones with CLOCK_MONOTONIC: the stamp is of the
// clock it is nearer to. The distance of the two clocks is taken at that moment, so a wall clock being set
// meanwhile makes an edge wrong by so much.
Instant instant_of(const timespec& stamp) {
  const auto ns = [](const timespec& t) {
    return std::chrono::seconds(t.tv_sec) + std::chrono::nanoseconds(t.tv_nsec);
  };
  timespec monotonic{};
  timespec wall{};
  clock_gettime(CLOCK_MONOTONIC, &monotonic);
  clock_gettime(CLOCK_REALTIME, &wall);
  const Duration at = ns(stamp);
  if (std::chrono::abs(at - ns(monotonic)) <= std::chrono::abs(at - ns(wall))) return Instant(at);
  return Instant(at - (ns(wall) - ns(monotonic)));
}

class In final : public EdgeIn {
 public:
  In(Request request, bool edges)
      : request_(std::move(request)), line_(gpiod_line_bulk_get_line(&request_.lines, 0)), edges_(edges) {}

 private:
  Result<bool> do_active() override {
    const int value = gpiod_line_get_value(line_);
    if (value < 0) return gpio_failure(request_.name, "read", errno);
    return value != 0;
  }
  Result<std::size_t> do_edges(std::span<Edge> into) override;
  std::string_view do_name() const override { return request_.name; }

  Request request_;
  gpiod_line* line_;
  bool edges_;
};

Result<std::size_t> In::do_edges(std::span<Edge> into) {
  if (!edges_)
    return fail(ErrorCode::invalid_state, request_.name, "read edges", "it was opened without them");
  constexpr timespec kAtOnce{0, 0};
  std::size_t count = 0;
  while (count < into.size()) {
    const int waiting = gpiod_line_event_wait(line_, &kAtOnce);
    if (waiting == 0) break;
    gpiod_line_event event{};
    if (waiting < 0 || gpiod_line_event_read(line_, &event) != 0)
      return gpio_failure(request_.name, "read edges", errno);
    into[count++] = {instant_of(event.ts), event.event_type == GPIOD_LINE_EVENT_RISING_EDGE};
  }
  return count;
}

Result<std::unique_ptr<In>> open_in(const GpioLineConfig& config) {
  const bool edges = config.edges == GpioEdges::both;
  auto made =
      request({config}, edges ? GPIOD_LINE_REQUEST_EVENT_BOTH_EDGES : GPIOD_LINE_REQUEST_DIRECTION_INPUT);
  if (!made) return fail(std::move(made).error());
  return std::make_unique<In>(*std::move(made), edges);
}

}  // namespace

Result<std::unique_ptr<DigitalOut>> open_gpio_out(const GpioLineConfig& config) {
  auto made = request({config}, GPIOD_LINE_REQUEST_DIRECTION_OUTPUT);
  if (!made) return fail(std::move(made).error());
  return std::make_unique<Out>(*std::move(made), config.at_end);
}

Result<std::unique_ptr<DigitalOutGroup>> open_gpio_group(const std::vector<GpioLineConfig>& lines) {
  FORAGER_TRY(check_gpio_group(lines));
  auto made = request(lines, GPIOD_LINE_REQUEST_DIRECTION_OUTPUT);
  if (!made) return fail(std::move(made).error());
  return std::make_unique<Group>(*std::move(made), lines[0].at_end);
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
    for (unsigned offset = 0; chip && offset < gpiod_chip_num_lines(chip.get()); ++offset) {
      gpiod_line* line = gpiod_chip_get_line(chip.get(), offset);
      if (line == nullptr) continue;
      const auto text = [](const char* words) { return std::string(words == nullptr ? "" : words); };
      facts.push_back({gpiod_chip_name(chip.get()), gpiod_chip_label(chip.get()), offset,
                       text(gpiod_line_name(line)),
                       gpiod_line_is_used(line) ? text(gpiod_line_consumer(line)) : "",
                       gpiod_line_direction(line) == GPIOD_LINE_DIRECTION_OUTPUT,
                       gpiod_line_active_state(line) == GPIOD_LINE_ACTIVE_STATE_LOW});
    }
  }
  if (facts.empty() && refused != 0) return gpio_failure("gpio", "list", refused);
  return facts;
}

std::string gpio_library() { return fmt::format("libgpiod {}", gpiod_version_string()); }

}  // namespace forager::hal
