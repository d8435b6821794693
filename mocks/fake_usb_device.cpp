#include "mocks/fake_usb_device.hpp"

#include <algorithm>
#include <utility>

namespace forager::mocks {

using hal::ErrorCode;

namespace {

constexpr hal::Duration kFrame = std::chrono::milliseconds(1);  // of full speed; high speed has eighths
constexpr int kLastFrames = 20;

}  // namespace

FakeUsbDevice::FakeUsbDevice(std::shared_ptr<FakeUsbSocket> socket)
    : hal::UsbDevice(socket->facts), socket_(std::move(socket)) {
  socket_->before_unplug.emplace_back(this, [this] { everything_arrives(); });
}

FakeUsbDevice::~FakeUsbDevice() {
  for (std::size_t i = 0; i < facts().interfaces.size(); ++i)
    if (claimed(facts().interfaces[i].number)) unclaim(i);
  auto& calls = socket_->before_unplug;
  calls.erase(
      std::remove_if(calls.begin(), calls.end(), [this](const auto& call) { return call.first == this; }),
      calls.end());
}

hal::Result<> FakeUsbDevice::admit(const std::string& operation) {
  if (socket_->next_error) return hal::fail(*std::exchange(socket_->next_error, std::nullopt));
  if (!socket_->plugged) return failed(ErrorCode::disconnected, operation, "the plug is out");
  return {};
}

hal::Failure FakeUsbDevice::stalled(const std::string& operation) const {
  return failed(ErrorCode::refused, operation, "the device stalled");
}

std::size_t FakeUsbDevice::index_of(std::uint8_t interface) const {
  const auto& all = facts().interfaces;
  return static_cast<std::size_t>(
      std::find_if(all.begin(), all.end(), [&](const auto& each) { return each.number == interface; }) -
      all.begin());
}

void FakeUsbDevice::unclaim(std::size_t index) {
  socket_->claimed[index] = false;
  socket_->facts.interfaces[index].driver = socket_->drivers[index];
}

hal::Result<> FakeUsbDevice::do_claim(std::uint8_t interface) {
  FORAGER_TRY(admit("claim"));
  const std::size_t index = index_of(interface);
  if (socket_->claimed[index]) return failed(ErrorCode::busy, "claim", "another program has it");
  socket_->claimed[index] = true;
  socket_->facts.interfaces[index].driver = "usbfs";
  return {};
}

hal::Result<> FakeUsbDevice::do_release(std::uint8_t interface) {
  unclaim(index_of(interface));
  return admit("release");
}

hal::Result<std::size_t> FakeUsbDevice::do_control_in(const hal::UsbRequest& request,
                                                      std::span<std::byte> into, hal::Duration) {
  if (auto admitted = admit("request"); !admitted) return hal::fail(std::move(admitted).error());
  const auto got = socket_->device->control_in(request, into);
  if (!got) return stalled("request");
  return *got;
}

hal::Result<> FakeUsbDevice::do_control_out(const hal::UsbRequest& request, std::span<const std::byte> bytes,
                                            hal::Duration) {
  FORAGER_TRY(admit("request"));
  if (!socket_->device->control_out(request, bytes)) return stalled("request");
  return {};
}

SimUsbAnswer FakeUsbDevice::fill(const hal::UsbEndpointFacts& endpoint, Transfer& transfer, bool& ended) {
  const std::span<std::byte> room(transfer.bytes);
  ended = false;
  while (true) {
    const SimUsbPacket packet =
        socket_->device->packet_in(endpoint.address, room.subspan(transfer.done, endpoint.max_packet_bytes));
    if (packet.answer != SimUsbAnswer::ack) return packet.answer;
    transfer.done += packet.bytes;
    ended = packet.bytes < endpoint.max_packet_bytes || transfer.done == transfer.bytes.size();
    if (ended) return SimUsbAnswer::ack;
  }
}

SimUsbAnswer FakeUsbDevice::send(const hal::UsbEndpointFacts& endpoint, Transfer& transfer) {
  const std::span<const std::byte> bytes(transfer.bytes);
  do {
    const auto packet = bytes.subspan(
        transfer.done, std::min<std::size_t>(bytes.size() - transfer.done, endpoint.max_packet_bytes));
    const SimUsbAnswer answer = socket_->device->packet_out(endpoint.address, packet);
    if (answer != SimUsbAnswer::ack) return answer;
    transfer.done += packet.size();
  } while (transfer.done < bytes.size());
  return SimUsbAnswer::ack;
}

template <class Act>
void FakeUsbDevice::each_pipe(const Act& act) {
  for (const hal::UsbInterfaceFacts& interface : facts().interfaces)
    for (const hal::UsbEndpointFacts& endpoint : interface.endpoints)
      if (auto& pipe = pipes_[endpoint.address]) act(endpoint, *pipe);
}

// The controller serves every endpoint by itself.
void FakeUsbDevice::frame() {
  if (!socket_->plugged) return;
  socket_->device->start_of_frame();
  each_pipe([this](const auto& endpoint, Pipe& pipe) {
    endpoint.in() ? pump_in(endpoint, pipe) : pump_out(endpoint, pipe);
  });
}

hal::Result<std::size_t> FakeUsbDevice::do_bulk_in(const hal::UsbEndpointFacts& endpoint,
                                                   std::span<std::byte> into, hal::Duration at_most) {
  if (auto admitted = admit("read"); !admitted) return hal::fail(std::move(admitted).error());
  Transfer transfer{std::vector<std::byte>(into.size())};
  bool ended = false;
  for (hal::Duration waited{}; !ended && waited < at_most; waited += kFrame) {
    if (fill(endpoint, transfer, ended) == SimUsbAnswer::stall) return stalled("read");
    if (!ended) frame();
  }
  if (!ended && transfer.done == 0) return failed(ErrorCode::timeout, "read", "nothing came");
  std::copy_n(transfer.bytes.begin(), transfer.done, into.begin());
  return transfer.done;
}

hal::Result<> FakeUsbDevice::do_bulk_out(const hal::UsbEndpointFacts& endpoint,
                                         std::span<const std::byte> bytes, hal::Duration at_most) {
  FORAGER_TRY(admit("write"));
  Transfer transfer{{bytes.begin(), bytes.end()}};
  for (hal::Duration waited{}; waited < at_most; waited += kFrame) {
    const SimUsbAnswer answer = send(endpoint, transfer);
    if (answer == SimUsbAnswer::stall) return stalled("write");
    if (answer == SimUsbAnswer::ack) return {};
    frame();
  }
  return failed(ErrorCode::timeout, "write", "the device takes no more");
}

hal::Result<> FakeUsbDevice::do_clear_halt(const hal::UsbEndpointFacts& endpoint) {
  FORAGER_TRY(admit("clear halt"));
  socket_->device->clear_halt(endpoint.address);
  if (auto& pipe = pipes_[endpoint.address]) pipe->stalled = false;
  return {};
}

hal::Result<> FakeUsbDevice::do_start(const hal::UsbEndpointFacts& endpoint,
                                      const hal::UsbPipeConfig& config) {
  FORAGER_TRY(admit("start a pipe"));
  pipes_[endpoint.address].emplace(config);
  return {};
}

void FakeUsbDevice::pump_in(const hal::UsbEndpointFacts& endpoint, Pipe& pipe) {
  while (socket_->plugged && !pipe.stalled && pipe.ended.size() < pipe.config.transfers) {
    if (!pipe.filling) pipe.filling = Transfer{std::vector<std::byte>(pipe.config.bytes)};
    bool ended = false;
    pipe.stalled = fill(endpoint, *pipe.filling, ended) == SimUsbAnswer::stall;
    if (!ended) return;
    pipe.ended.push_back(*std::exchange(pipe.filling, std::nullopt));
  }
}

void FakeUsbDevice::pump_out(const hal::UsbEndpointFacts& endpoint, Pipe& pipe) {
  while (socket_->plugged && !pipe.stalled && !pipe.leaving.empty()) {
    const SimUsbAnswer answer = send(endpoint, pipe.leaving.front());
    pipe.stalled = answer == SimUsbAnswer::stall;
    if (answer != SimUsbAnswer::ack) return;
    pipe.leaving.pop_front();
  }
}

void FakeUsbDevice::everything_arrives() {
  for (int i = 0; i < kLastFrames; ++i) frame();
  each_pipe([](const auto&, Pipe& pipe) {
    if (pipe.filling && pipe.filling->done > 0)
      pipe.ended.push_back(*std::exchange(pipe.filling, std::nullopt));
  });
}

hal::Result<std::optional<std::size_t>> FakeUsbDevice::do_poll_in(const hal::UsbEndpointFacts& endpoint,
                                                                  std::span<std::byte> into) {
  Pipe& pipe = *pipes_[endpoint.address];
  frame();
  pump_in(endpoint, pipe);
  if (pipe.ended.empty()) {
    if (auto admitted = admit("read"); !admitted) return hal::fail(std::move(admitted).error());
    if (pipe.stalled) return stalled("read");
    return std::nullopt;
  }
  const Transfer& oldest = pipe.ended.front();
  const std::size_t count = oldest.done;
  std::copy_n(oldest.bytes.begin(), count, into.begin());
  pipe.ended.pop_front();
  return count;
}

hal::Result<std::size_t> FakeUsbDevice::do_push_out(const hal::UsbEndpointFacts& endpoint,
                                                    std::span<const std::byte> bytes) {
  if (auto admitted = admit("write"); !admitted) return hal::fail(std::move(admitted).error());
  Pipe& pipe = *pipes_[endpoint.address];
  frame();
  pump_out(endpoint, pipe);
  if (pipe.stalled) return stalled("write");
  std::size_t taken = 0;
  while (taken < bytes.size() && pipe.leaving.size() < pipe.config.transfers) {
    const auto piece = bytes.subspan(taken, std::min(bytes.size() - taken, pipe.config.bytes));
    pipe.leaving.push_back({{piece.begin(), piece.end()}});
    taken += piece.size();
    pump_out(endpoint, pipe);
  }
  return taken;
}

hal::Result<> FakeUsbDevice::do_drain(const hal::UsbEndpointFacts& endpoint, hal::Duration at_most) {
  FORAGER_TRY(admit("drain"));
  Pipe& pipe = *pipes_[endpoint.address];
  for (hal::Duration waited{}; !pipe.leaving.empty() && waited < at_most; waited += kFrame) {
    pump_out(endpoint, pipe);
    if (pipe.stalled) return stalled("drain");
    frame();
  }
  if (!pipe.leaving.empty()) return failed(ErrorCode::timeout, "drain", "the device takes no more");
  return {};
}

void FakeUsbDevice::do_stop(const hal::UsbEndpointFacts& endpoint) { pipes_[endpoint.address].reset(); }

}  // namespace forager::mocks
