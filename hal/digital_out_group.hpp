#pragma once

#include <cstddef>
#include <span>
#include <string_view>

#include "hal/error.hpp"

namespace forager::hal {

// Several outputs of one chip that change together, in one call to the hardware: two brakes that must not
// lock one after the other. Logical levels as DigitalOut; safe state: all inactive.
class DigitalOutGroup {
 public:
  virtual ~DigitalOutGroup() = default;
  // One level for each line, in the order the group was opened with. Errors: invalid_argument (another number
  // of levels than lines; nothing was set), and those of DigitalOut::set().
  [[nodiscard]] Result<> set(std::span<const bool> active);
  [[nodiscard]] std::size_t size() const { return do_size(); }
  [[nodiscard]] std::string_view name() const { return do_name(); }

 private:
  virtual Result<> do_set(std::span<const bool> active) = 0;
  [[nodiscard]] virtual std::size_t do_size() const = 0;
  [[nodiscard]] virtual std::string_view do_name() const = 0;
};

inline Result<> DigitalOutGroup::set(std::span<const bool> active) {
  if (active.size() != size())
    return fail(ErrorCode::invalid_argument, std::string(name()), "set",
                std::to_string(active.size()) + " levels for " + std::to_string(size()) + " lines");
  return do_set(active);
}

}  // namespace forager::hal
