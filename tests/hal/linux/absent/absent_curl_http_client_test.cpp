#include <gtest/gtest.h>

#include "hal/linux/curl_http_client.hpp"

namespace forager::hal {
namespace {

TEST(AbsentHttpClient, SaysWhatToInstall) {
  auto client = make_curl_http_client("http://192.168.1.50:3161");
  const auto started = client->start({HttpMethod::get, "/devices", "", "", 1s}, Instant());
  ASSERT_FALSE(started.has_value());
  EXPECT_EQ(ErrorCode::unsupported, started.error().code);
  EXPECT_EQ("http http://192.168.1.50:3161", started.error().device);
  EXPECT_NE(std::string::npos, started.error().mend.find("libcurl4-openssl-dev"));
  EXPECT_EQ(ErrorCode::invalid_state, client->poll(Instant()).error().code);
  client->cancel();
}

}  // namespace
}  // namespace forager::hal
