#include "boards/speed_contest.hpp"

namespace forager::boards {

std::vector<SpeedContest> speed_contests() { return {}; }

}  // namespace forager::boards
