#pragma once

#include <cstddef>
#include <string_view>

#include "mocks/sim_reader.hpp"

namespace forager::mocks {

// One property or operation below /devices/{id}: GET is getter or operation, PUT is setter.
struct SimReader::Operation {
  std::string_view name;
  hal::HttpMethod method;
  std::size_t min_arguments;  // path segments after the name
  std::size_t max_arguments;
  bool changes_setup;  // refused while RUNNING, if so configured
  Handler handler;
};

}  // namespace forager::mocks
