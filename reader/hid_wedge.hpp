#pragma once

#include <memory>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "hal/hid.hpp"
#include "reader/backoff.hpp"
#include "reader/tag_reader.hpp"
#include "reader/wedge_text.hpp"

namespace forager::reader {

struct HidWedgeConfig {
  // Vendor and product of the reader; a keyboard (usage 1:6) is wanted whatever they are.
  hal::HidMatch device{};
  std::size_t epc_digits = 0;                            // see WedgeText
  hal::Duration pause = std::chrono::milliseconds(200);  // ends an EPC that nothing else ends
  hal::Duration retry_first = std::chrono::milliseconds(200);
  hal::Duration retry_cap = std::chrono::seconds(5);
};

// The keyboards among what fits (HID Usage Tables, section 4), unless it asks for another usage.
[[nodiscard]] hal::HidMatch keyboard(hal::HidMatch match);

// A reader that types EPCs as a keyboard (the USB HID service of AdvanReader-70 and -160). It tells neither
// port nor RSSI nor time, it cannot be asked or told anything, and its silence has no reason: link() is open
// as long as it is plugged in. Taken exclusively, so that its keys end here and nowhere else; unplugged and
// plugged in again, it goes on by itself. Call update() at least every 25 ms: the kernel keeps 64 reports, a
// keyboard sends at most one a millisecond, and an EPC of 96 bits takes 50.
//
// Halting stops listening; the reader itself goes on reading.
class HidWedge final : public TagReader {
 public:
  // `hid` must outlive it.
  HidWedge(hal::Hid& hid, const HidWedgeConfig& config);

  void start(hal::Instant now) override;
  void update(hal::Instant now) override;
  void halt() noexcept override;
  [[nodiscard]] std::span<const TagRead> reads() const override { return reads_; }
  [[nodiscard]] const LinkStatus& link() const override { return link_; }

  [[nodiscard]] const WedgeText& text() const { return text_; }

 private:
  void open(hal::Instant now);
  void lose(const hal::Error& error, hal::Instant now);
  void enter(LinkPhase phase, std::string reason, hal::Instant now);

  hal::Hid* hid_;
  HidWedgeConfig config_;
  std::unique_ptr<hal::HidDevice> device_;
  WedgeText text_;
  Backoff backoff_;
  hal::Instant next_try_;
  hal::Instant now_;
  LinkStatus link_;
  std::vector<Epc> epcs_;
  std::vector<TagRead> reads_;
};

}  // namespace forager::reader
