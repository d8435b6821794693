#include <iostream>

#include "hal/linux/curl_http_client.hpp"
#include "mocks/memory_stream.hpp"
#include "reader/epc.hpp"

int main() {
  const auto epc = forager::reader::Epc::from_hex("3034257BF7194E4000001A85");
  forager::mocks::MemoryStreamPair line("line", forager::mocks::MemoryStreamKind::bytes);
  const auto client = forager::hal::make_curl_http_client("http://192.168.1.50:3161");
  std::cout << epc.value().hex() << ' ' << line.near().name() << ' ' << client->name() << '\n';
}
