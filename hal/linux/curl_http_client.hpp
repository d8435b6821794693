#pragma once

#include <memory>
#include <optional>
#include <string>

#include "hal/http_client.hpp"

namespace forager::hal {

struct HttpCredentials {
  std::string user;
  std::string password;
};

// One HTTP server at base_url ("http://192.168.1.50:3161", no path). Keeps its connection alive between
// requests, uses no proxy, follows no redirect, raises no signal. Credentials answer a Digest challenge only:
// Basic would send the password readable. Until the first challenge a request goes out bare; afterwards the
// digest is sent along at once. Answers larger than 16 MiB are a protocol error.
//
// Built without libcurl, every start() answers unsupported with the package to install.
[[nodiscard]] std::unique_ptr<HttpClient> make_curl_http_client(
    std::string base_url, std::optional<HttpCredentials> credentials = std::nullopt);

}  // namespace forager::hal
