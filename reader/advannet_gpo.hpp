#pragma once

#include <cstdint>
#include <optional>
#include <string>

#include "hal/digital_out.hpp"
#include "hal/error.hpp"

namespace forager::reader {

// One digital output of the reader (GPO line, 1-based; a relay and the like are higher lines). set() only
// notes what is wanted; the driver tells the reader as soon as its one REST connection is free. Several
// set() before that leave the last one. What the reader answered shows at the next set(). The driver makes
// these (AdvanNetReader::gpo), writes them inactive at the first contact, again after the reader restarted,
// and inactive at halt.
class AdvanNetGpo final : public hal::DigitalOut {
 public:
  explicit AdvanNetGpo(std::uint8_t line);

  [[nodiscard]] std::uint8_t line() const { return line_; }
  [[nodiscard]] bool wanted() const { return wanted_; }
  [[nodiscard]] bool settled() const { return told_ == wanted_; }

  // For the driver.
  void confirm(bool active) { told_ = active; }
  void forget() { told_.reset(); }  // the reader may have lost it: tell it again
  void want_inactive() { wanted_ = false; }
  void reject(bool active, hal::Error error);  // shown once at the next set(); not tried again until then

 private:
  hal::Result<> do_set(bool active) override;
  std::string_view do_name() const override { return name_; }

  std::uint8_t line_;
  std::string name_;
  bool wanted_ = false;
  std::optional<bool> told_;
  std::optional<hal::Error> error_;
};

}  // namespace forager::reader
