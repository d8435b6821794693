#include <fmt/format.h>

#include <algorithm>
#include <chrono>
#include <memory>
#include <optional>
#include <thread>
#include <utility>

#include "boards/overhead_contest.hpp"
#include "hal/cdc_acm.hpp"
#include "hal/cdc_acm_wire.hpp"
#include "hal/ftdi.hpp"
#include "hal/ftdi_wire.hpp"
#include "hal/linux/bare_calls.hpp"
#include "hal/linux/steady_clock.hpp"
#include "hal/linux/usb_bus.hpp"

namespace forager::boards {
namespace {

using namespace std::chrono_literals;

constexpr std::size_t kBytes = 4096;  // of a transfer, either way
constexpr hal::Duration kPatience = 1s;
// Between two looks at a line that has nothing to do: less than what the transfers under way take, even at
// high speed (40 MB/s).
constexpr std::size_t kTransfers = 16;
constexpr hal::Duration kIdle = 200us;

// An adapter, and how it is spoken to below the serial line.
struct Adapter {
  hal::UsbSerialConfig serial{};
  hal::BareUsbConfig out{};
  hal::BareUsbConfig in{};
  bool ftdi = false;
};

hal::Result<Adapter> inspect(const OverheadUsbPlace& place, const hal::UsbDeviceFacts& device) {
  using namespace hal::cdc_acm;
  Adapter adapter;
  adapter.ftdi = place.vendor == hal::ftdi::kVendor;
  adapter.serial.device = {
      .vendor = place.vendor, .product = place.product, .serial = {}, .path = device.path};
  adapter.serial.line.baud = place.baud;
  adapter.serial.pipe = {.bytes = kBytes, .transfers = kTransfers};
  hal::BareUsbConfig bare{.device = device, .bytes = kBytes};
  for (const hal::UsbInterfaceFacts& interface : device.interfaces) {
    const bool control =
        interface.class_code == kCommunicationClass && interface.subclass == kAbstractControl;
    const bool data = adapter.ftdi || interface.class_code == kDataClass;
    if (control || data) bare.interfaces.push_back(interface.number);
    if (control)
      bare.requests.push_back({hal::UsbRequestKind::class_specific, hal::UsbRecipient::interface,
                               kSetControlLineState, kDtr | kRts, interface.number});
    for (const hal::UsbEndpointFacts& endpoint : interface.endpoints) {
      if (!data || endpoint.type != hal::UsbTransferType::bulk) continue;
      (endpoint.in() ? adapter.in : adapter.out).endpoint = endpoint.address;
      bare.packet_bytes = endpoint.max_packet_bytes;
    }
    if (data) break;  // the first port
  }
  if (adapter.ftdi)
    bare.requests.push_back({hal::UsbRequestKind::vendor, hal::UsbRecipient::device,
                             hal::ftdi::kSetModemControl, hal::ftdi::kDtrHigh, 0});
  if (adapter.in.endpoint == 0 || adapter.out.endpoint == 0)
    return hal::fail(hal::ErrorCode::unsupported, describe(device), "open",
                     "this is neither a CDC-ACM nor an FTDI adapter", "See what there is: forager usb list");
  const auto with = [&bare](std::uint8_t endpoint) {
    hal::BareUsbConfig one = bare;
    one.endpoint = endpoint;
    return one;
  };
  adapter.out = with(adapter.out.endpoint);
  adapter.in = with(adapter.in.endpoint);
  if (adapter.ftdi) adapter.in.status_bytes = hal::ftdi::kStatusBytes;
  return adapter;
}

// A port in user space with the bus it needs.
struct Port {
  std::unique_ptr<hal::Usb> usb;
  std::unique_ptr<hal::UsbSerial> serial;
  std::vector<std::byte> memory = std::vector<std::byte>(kBytes);

  // So many bytes through `move`, which gives what went at once.
  template <class Move>
  hal::Result<std::uint64_t> stream(std::uint64_t bytes, const Move& move) {
    std::uint64_t done = 0;
    std::optional<hal::Deadline> give_up;
    while (done < bytes) {
      const hal::Result<std::size_t> moved = move(std::min<std::uint64_t>(kBytes, bytes - done));
      if (!moved) return hal::fail(moved.error());
      done += *moved;
      if (*moved > 0) {
        give_up.reset();
        continue;
      }
      const hal::Instant now = clock->now();
      if (!give_up) give_up.emplace(now, kPatience);
      if (give_up->expired(now))
        return hal::fail(hal::ErrorCode::timeout, std::string(serial->name()), "stream",
                         fmt::format("no byte has moved for {} s", kPatience / 1s));
      std::this_thread::sleep_for(kIdle);
    }
    return done;
  }

  std::unique_ptr<hal::Clock> clock = hal::make_steady_clock();
};

hal::Result<std::shared_ptr<Port>> open_port(const Adapter& adapter) {
  auto usb = hal::open_usb_bus();
  if (!usb) return hal::fail(std::move(usb).error());
  auto port = std::make_shared<Port>();
  port->usb = *std::move(usb);
  if (adapter.ftdi)
    port->serial = hal::make_ftdi(*port->usb, {.usb = adapter.serial});
  else
    port->serial = hal::make_cdc_acm(*port->usb, adapter.serial);
  FORAGER_TRY(port->serial->open());
  while (true) {
    const auto state = port->serial->poll();
    if (!state) return hal::fail(state.error());
    if (*state == hal::StreamState::open) return port;
  }
}

hal::Result<OverheadContest::Side> open_out(const Adapter& adapter) {
  auto port = open_port(adapter);
  if (!port) return hal::fail(std::move(port).error());
  const auto run = [port = *port](std::uint64_t calls) {
    return port->stream(calls * kBytes, [&](std::size_t most) {
      return port->serial->write(std::span(port->memory).first(most));
    });
  };
  // From here on the pipe is full: as many bytes are taken as leave.
  if (const auto filled = run(2 * kTransfers); !filled) return hal::fail(filled.error());
  return OverheadContest::Side(run);
}

hal::Result<OverheadContest::Side> open_in(const Adapter& adapter) {
  auto port = open_port(adapter);
  if (!port) return hal::fail(std::move(port).error());
  const auto run = [port = *port](std::uint64_t calls) {
    return port->stream(calls * kBytes, [&](std::size_t most) {
      return port->serial->read(std::span(port->memory).first(most));
    });
  };
  // What came in the meantime is not timed.
  if (const auto emptied = run(2 * kTransfers); !emptied) return hal::fail(emptied.error());
  return OverheadContest::Side(run);
}

hal::Result<OverheadContest::Side> open_bulk(const Adapter& adapter) {
  auto usb = hal::open_usb_bus();
  if (!usb) return hal::fail(std::move(usb).error());
  auto device = (*usb)->open(adapter.serial.device);
  if (!device) return hal::fail(std::move(device).error());
  for (const std::uint8_t interface : adapter.out.interfaces) FORAGER_TRY((*device)->claim(interface));
  for (const hal::UsbRequest& request : adapter.out.requests)
    FORAGER_TRY((*device)->control_out(request, {}, kPatience));
  const auto run = [bus = std::shared_ptr<hal::Usb>(*std::move(usb)),
                    open = std::shared_ptr<hal::UsbDevice>(*std::move(device)), out = adapter.out.endpoint,
                    memory =
                        std::vector<std::byte>(kBytes)](std::uint64_t calls) -> hal::Result<std::uint64_t> {
    for (std::uint64_t i = 0; i < calls; ++i) FORAGER_TRY(open->bulk_out(out, memory, kPatience));
    return calls * kBytes;
  };
  return OverheadContest::Side(run);
}

}  // namespace

hal::Result<std::vector<OverheadContest>> overhead_usb(const OverheadUsbPlace& place) {
  auto usb = hal::open_usb_bus();
  if (!usb) return hal::fail(std::move(usb).error());
  // Opening it tells every way in which it cannot be opened.
  const auto tried =
      (*usb)->open({.vendor = place.vendor, .product = place.product, .serial = {}, .path = {}});
  if (!tried) return hal::fail(tried.error());
  const auto adapter = inspect(place, (*tried)->facts());
  if (!adapter) return hal::fail(adapter.error());
  const auto contest = [&](const char* name, const char* ours, auto open, const hal::BareUsbConfig& bare) {
    return OverheadContest{.name = name,
                           .ours = ours,
                           .bare = hal::usb_library(),
                           .unit = "byte",
                           .batch = 20ms,
                           .open_ours = [open, adapter = *adapter] { return open(adapter); },
                           .open_bare = [bare] { return hal::open_bare_usb(bare); }};
  };
  // The serial port first: it sets the line's rate, which the others then find.
  std::vector all{contest("USB serial, to the device", "UsbSerial::write", open_out, adapter->out),
                  contest("USB serial, from the device", "UsbSerial::read", open_in, adapter->in),
                  contest("USB bulk transfer", "UsbDevice::bulk_out", open_bulk, adapter->out)};
  all[1].may_be_silent = true;
  return all;
}

}  // namespace forager::boards
