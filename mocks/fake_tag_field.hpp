#pragma once

#include <cstdint>
#include <string>
#include <utility>
#include <vector>

#include "mocks/tag_field.hpp"

namespace forager::mocks {

// Air in which exactly the replies a test puts in are heard, while the radio is on and only on ports it uses;
// remembers what the radio was told.
class FakeTagField final : public TagField {
 public:
  // Index of a new tag.
  std::uint32_t add_tag(std::string epc_hex) {
    epcs_.push_back(std::move(epc_hex));
    return static_cast<std::uint32_t>(epcs_.size() - 1);
  }
  // A reply to come; give them in time order.
  void add_reply(const AirRead& read) { replies_.push_back(read); }

  [[nodiscard]] bool on() const { return on_; }
  [[nodiscard]] int times_on() const { return times_on_; }
  [[nodiscard]] const RadioSettings& settings() const { return settings_; }

  void radio_on(const RadioSettings& settings, hal::Instant now) override;
  void radio_off(hal::Instant now) override;
  void advance(hal::Instant now, std::vector<AirRead>& out) override;
  [[nodiscard]] const std::string& epc_hex(std::uint32_t tag) const override { return epcs_.at(tag); }

 private:
  void skip_until(hal::Instant now);

  std::vector<std::string> epcs_;
  std::vector<AirRead> replies_;
  std::size_t next_ = 0;
  RadioSettings settings_;
  bool on_ = false;
  int times_on_ = 0;
};

}  // namespace forager::mocks
