#pragma once

#include <functional>
#include <string>
#include <vector>

namespace forager::kernel {

// What `body` answers in a child process. The child sees the devices as they are; nothing else it does comes
// back.
[[nodiscard]] std::string in_a_child(const std::function<std::string()>& body);
// The same of the user nobody, who is in these groups only.
[[nodiscard]] std::string as_nobody(const std::vector<std::string>& groups,
                                    const std::function<std::string()>& body);

}  // namespace forager::kernel
