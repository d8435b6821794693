#include "hal/linux/libusb_pipe.hpp"

#include <fmt/format.h>
#include <libusb.h>

#include <algorithm>

#include "hal/linux/libusb_error.hpp"

namespace forager::hal {
namespace {

constexpr Duration kCancel = std::chrono::seconds(1);  // the kernel gives cancelled transfers back at once

}  // namespace

LibusbPipe::LibusbPipe(libusb_context* context, libusb_device_handle* handle, std::string device,
                       const UsbEndpointFacts& endpoint, const UsbPipeConfig& config)
    : context_(context),
      handle_(handle),
      device_(std::move(device)),
      endpoint_(endpoint),
      owned_(std::make_unique<std::vector<Slot>>(config.transfers)),
      slots_(*owned_) {
  const auto ended = [](libusb_transfer* transfer) {
    static_cast<Slot*>(transfer->user_data)->state = State::ended;
  };
  for (Slot& slot : slots_) {
    slot.buffer.resize(config.bytes);
    slot.transfer = libusb_alloc_transfer(0);
    if (slot.transfer == nullptr) continue;
    auto* const memory = reinterpret_cast<unsigned char*>(slot.buffer.data());
    libusb_fill_bulk_transfer(slot.transfer, handle_, endpoint_.address, memory,
                              static_cast<int>(config.bytes), ended, &slot, 0);
    if (endpoint_.type == UsbTransferType::interrupt) slot.transfer->type = LIBUSB_TRANSFER_TYPE_INTERRUPT;
  }
}

LibusbPipe::~LibusbPipe() {
  for (Slot& slot : slots_)
    if (slot.state == State::under_way) libusb_cancel_transfer(slot.transfer);
  // What the kernel does not give back must not be freed: it would write into memory of others.
  if (!wait(kCancel)) {
    static_cast<void>(owned_.release());
    return;
  }
  for (Slot& slot : slots_) libusb_free_transfer(slot.transfer);
}

std::string LibusbPipe::operation() const {
  return fmt::format("{} endpoint 0x{:02x}", endpoint_.in() ? "read" : "write", endpoint_.address);
}

void LibusbPipe::events(Duration at_most) {
  const auto us = at_most / std::chrono::microseconds(1);
  timeval time{us / 1'000'000, us % 1'000'000};
  libusb_handle_events_timeout_completed(context_, &time, nullptr);
}

bool LibusbPipe::wait(Duration at_most) {
  const auto busy = [this] {
    return std::any_of(slots_.begin(), slots_.end(),
                       [](const Slot& slot) { return slot.state == State::under_way; });
  };
  const auto give_up = std::chrono::steady_clock::now() + at_most;
  while (busy()) {
    const Duration left = give_up - std::chrono::steady_clock::now();
    if (left <= Duration::zero()) return false;
    events(std::min<Duration>(left, std::chrono::milliseconds(100)));
  }
  return true;
}

Failure LibusbPipe::broken(int error) {
  for (Slot& slot : slots_)
    if (slot.state == State::under_way) libusb_cancel_transfer(slot.transfer);
  static_cast<void>(wait(kCancel));
  for (Slot& slot : slots_)
    if (slot.state == State::ended) slot.state = State::idle;
  failed_ = 0;
  return libusb_failure(device_, operation(), error);
}

Result<> LibusbPipe::submit(Slot& slot, std::size_t bytes) {
  if (slot.transfer == nullptr) return libusb_failure(device_, operation(), LIBUSB_ERROR_NO_MEM);
  slot.transfer->length = static_cast<int>(bytes);
  slot.state = State::under_way;
  const int answer = libusb_submit_transfer(slot.transfer);
  if (answer == 0) return {};
  slot.state = State::idle;
  return libusb_failure(device_, operation(), answer);
}

Result<> LibusbPipe::submit_idle() {
  for (std::size_t i = 0; i < slots_.size(); ++i) {
    Slot& slot = slots_[(oldest_ + i) % slots_.size()];
    if (slot.state == State::idle) FORAGER_TRY(submit(slot, slot.buffer.size()));
  }
  return {};
}

Result<> LibusbPipe::start() {
  if (!endpoint_.in()) return {};
  return submit_idle();
}

Result<std::optional<std::size_t>> LibusbPipe::poll_in(std::span<std::byte> into) {
  events(Duration::zero());
  if (failed_ != 0) return broken(failed_);
  Slot& slot = oldest();
  if (slot.state == State::idle) {
    if (auto submitted = submit_idle(); !submitted) return fail(std::move(submitted).error());
  }
  if (slot.state == State::under_way) return std::nullopt;
  const auto got = static_cast<std::size_t>(slot.transfer->actual_length);
  const bool whole = slot.transfer->status == LIBUSB_TRANSFER_COMPLETED;
  if (!whole && got == 0) return broken(libusb_error_of_transfer(slot.transfer->status));
  std::copy_n(slot.buffer.begin(), got, into.begin());
  slot.state = State::idle;
  oldest_ = (oldest_ + 1) % slots_.size();
  if (!whole) failed_ = libusb_error_of_transfer(slot.transfer->status);
  // When that fails the slot stays idle, and its turn tells why.
  if (whole) static_cast<void>(submit(slot, slot.buffer.size()));
  return got;
}

// Frees what has left; says what has not.
Result<> LibusbPipe::judge_sent() {
  for (Slot& slot : slots_) {
    if (slot.state != State::ended) continue;
    if (slot.transfer->status != LIBUSB_TRANSFER_COMPLETED)
      return broken(libusb_error_of_transfer(slot.transfer->status));
    slot.state = State::idle;
  }
  return {};
}

Result<std::size_t> LibusbPipe::push_out(std::span<const std::byte> bytes) {
  events(Duration::zero());
  if (auto sent = judge_sent(); !sent) return fail(std::move(sent).error());
  std::size_t taken = 0;
  for (Slot& slot : slots_) {
    if (taken == bytes.size()) break;
    if (slot.state != State::idle) continue;
    const auto piece = bytes.subspan(taken, std::min(bytes.size() - taken, slot.buffer.size()));
    std::copy(piece.begin(), piece.end(), slot.buffer.begin());
    if (auto submitted = submit(slot, piece.size()); !submitted) return fail(std::move(submitted).error());
    taken += piece.size();
  }
  return taken;
}

Result<> LibusbPipe::drain(Duration at_most) {
  const bool gone = wait(at_most);
  FORAGER_TRY(judge_sent());
  if (gone) return {};
  return fail(ErrorCode::timeout, device_, operation(), "the device takes no more bytes");
}

}  // namespace forager::hal
