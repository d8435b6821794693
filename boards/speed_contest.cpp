#include "boards/speed_contest.hpp"

#include <iterator>

namespace forager::boards {

std::vector<SpeedContest> speed_contests() {
  using Topic = std::vector<SpeedContest> (*)();
  constexpr Topic kTopics[] = {
      speed_detection,
      speed_tag_grid,
  };
  std::vector<SpeedContest> contests;
  for (const Topic topic : kTopics) {
    std::vector<SpeedContest> more = topic();
    contests.insert(contests.end(), std::make_move_iterator(more.begin()),
                    std::make_move_iterator(more.end()));
  }
  return contests;
}

}  // namespace forager::boards
