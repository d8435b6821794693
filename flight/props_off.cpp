#include "flight/props_off.hpp"

#include <fmt/format.h>

namespace forager::flight {

hal::Result<PropsOff> PropsOff::confirm(std::string_view said) {
  if (said == kSentence) return PropsOff();
  return hal::fail(hal::ErrorCode::refused, "ESCs", "turn motors from the bench",
                   fmt::format("\"{}\" does not say that the propellers are off", said),
                   fmt::format("take every propeller off, then say \"{}\"", kSentence));
}

}  // namespace forager::flight
