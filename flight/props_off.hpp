#pragma once

#include <string_view>

#include "hal/error.hpp"

namespace forager::flight {

// A person's word that no propeller is mounted. Pulses that can turn a motor directly cannot be asked for
// without one; it can only be had by saying the sentence, never as a default.
class PropsOff {
 public:
  static constexpr std::string_view kSentence = "the propellers are off";

  // Errors: refused (anything but the sentence, to the letter).
  [[nodiscard]] static hal::Result<PropsOff> confirm(std::string_view said);

 private:
  PropsOff() = default;
};

}  // namespace forager::flight
