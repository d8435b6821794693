#pragma once

#include <string>
#include <string_view>

namespace forager::test {

// A file of tests/data/advannet.
[[nodiscard]] std::string advannet_file(std::string_view name);
// One <item> as the AdvanReader writes it; props is the inside of <props>.
[[nodiscard]] std::string advannet_item(std::string_view epc, long long ts_ms, std::string_view props);
// Items in the message around them.
[[nodiscard]] std::string advannet_inventory(std::string_view items);
// A body in its frame, with the blank lines behind it.
[[nodiscard]] std::string advannet_frame(std::string_view body);

}  // namespace forager::test
