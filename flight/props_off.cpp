#include "flight/props_off.hpp"

#include <string>

namespace forager::flight {

hal::Result<PropsOff> PropsOff::confirm(std::string_view said) {
  if (said == kSentence) return PropsOff();
  return hal::fail(hal::ErrorCode::refused, "ESCs", "turn motors from the bench",
                   said.empty() ? std::string("nobody said that the propellers are off")
                                : "\"" + std::string(said) + "\" is not the sentence",
                   "take every propeller off, then say \"" + std::string(kSentence) + "\"");
}

}  // namespace forager::flight
