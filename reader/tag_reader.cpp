#include "reader/tag_reader.hpp"

namespace forager::reader {

std::string_view to_string(LinkPhase phase) {
  switch (phase) {
    case LinkPhase::closed:
      return "closed";
    case LinkPhase::opening:
      return "opening";
    case LinkPhase::open:
      return "open";
    case LinkPhase::lost:
      return "lost";
    case LinkPhase::failed:
      return "failed";
  }
  return "unknown";
}

}  // namespace forager::reader
