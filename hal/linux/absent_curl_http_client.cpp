#include <utility>

#include "hal/linux/curl_http_client.hpp"

namespace forager::hal {

namespace {

class AbsentHttpClient final : public HttpClient {
 public:
  explicit AbsentHttpClient(std::string base_url) : name_("http " + std::move(base_url)) {}

 private:
  Result<> do_start(const HttpRequest& request, Instant) override {
    return fail(ErrorCode::unsupported, name_, "start request " + request.path, "built without libcurl",
                "Install libcurl4-openssl-dev and build again");
  }
  Result<std::optional<HttpResponse>> do_poll(Instant) override {
    return fail(ErrorCode::invalid_state, name_, "poll", "no request is in flight");
  }
  void do_cancel() override {}
  std::string_view do_name() const override { return name_; }

  std::string name_;
};

}  // namespace

std::unique_ptr<HttpClient> make_curl_http_client(std::string base_url, std::optional<HttpCredentials>) {
  return std::make_unique<AbsentHttpClient>(std::move(base_url));
}

}  // namespace forager::hal
