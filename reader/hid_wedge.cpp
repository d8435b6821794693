#include "reader/hid_wedge.hpp"

#include <array>
#include <utility>

namespace forager::reader {
namespace {

constexpr std::uint16_t kGenericDesktop = 0x01;  // HID Usage Tables, section 4
constexpr std::uint16_t kKeyboard = 0x06;
constexpr std::size_t kMostReports = 256;  // of one update: the kernel keeps 64

// What a person must see to; everything else may heal by itself.
bool final(hal::ErrorCode code) {
  return code == hal::ErrorCode::unsupported || code == hal::ErrorCode::invalid_argument;
}

}  // namespace

hal::HidMatch keyboard(hal::HidMatch match) {
  if (!match.usage_page) match.usage_page = kGenericDesktop;
  if (!match.usage) match.usage = kKeyboard;
  return match;
}

HidWedge::HidWedge(hal::Hid& hid, const HidWedgeConfig& config)
    : hid_(&hid), config_(config), text_(config.epc_digits), backoff_(config.retry_first, config.retry_cap) {
  config_.device = keyboard(config_.device);
}

void HidWedge::enter(LinkPhase phase, std::string reason, hal::Instant now) {
  if (link_.phase == phase && link_.reason == reason) return;
  if (link_.phase != phase) link_.since = now;
  link_.phase = phase;
  link_.reason = std::move(reason);
}

void HidWedge::start(hal::Instant now) {
  now_ = now;
  if (device_) return;
  backoff_.reset();
  enter(LinkPhase::opening, "", now);
  open(now);
}

void HidWedge::open(hal::Instant now) {
  auto device = hid_->open(config_.device, hal::HidSharing::exclusive);
  if (!device) return lose(device.error(), now);
  device_ = *std::move(device);
  text_.reset();
  backoff_.reset();
  link_.last_heard = now;
  enter(LinkPhase::open, "", now);
}

void HidWedge::lose(const hal::Error& error, hal::Instant now) {
  device_.reset();
  if (link_.phase == LinkPhase::open) ++link_.losses;
  next_try_ = now + backoff_.next();
  enter(final(error.code) ? LinkPhase::failed : LinkPhase::lost, hal::describe(error), now);
}

void HidWedge::update(hal::Instant now) {
  now_ = now;
  reads_.clear();
  epcs_.clear();
  if (link_.phase == LinkPhase::lost && now >= next_try_) open(now);
  if (!device_) return;
  std::array<std::byte, 64> report{};
  hal::Result<std::size_t> got = std::size_t{0};
  bool heard = false;
  for (std::size_t i = 0; i < kMostReports; ++i) {
    got = device_->poll(report);
    if (!got || *got == 0) break;
    text_.feed(std::span(report).first(*got), epcs_);
    heard = true;
  }
  if (heard) link_.last_heard = now;
  if (!heard && text_.in_word() && now - link_.last_heard >= config_.pause) text_.pause(epcs_);
  for (const Epc& epc : epcs_) {
    TagRead read;
    read.epc = epc;
    read.rssi_dbm = TagRead::kNoRssi;
    read.heard = now;
    read.arrived = now;
    reads_.push_back(read);
  }
  if (!got) lose(got.error(), now);
}

void HidWedge::halt() noexcept {
  device_.reset();
  enter(LinkPhase::closed, "", now_);
}

}  // namespace forager::reader
