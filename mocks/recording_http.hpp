#pragma once

#include "hal/http_client.hpp"
#include "mocks/recording_fields.hpp"

namespace forager::mocks {

// An HTTP client; borrows it. Credentials are not part of a request and are not recorded.
//   start get /devices - - 2000000000 = ok      method, path, type, body, time-out in nanoseconds
//   <answer = ok 200 <xml...                    status, body
//   cancel = ok
class RecordingHttpClient final : public hal::HttpClient {
 public:
  RecordingHttpClient(hal::HttpClient& client, hal::Recorder& recorder)
      : client_(&client), recorder_(&recorder) {}

  static hal::Fields fields_of(const hal::HttpRequest& request) {
    return {request.method == hal::HttpMethod::put ? "put" : "get", request.path, request.content_type,
            request.body, hal::field(request.timeout)};
  }

 private:
  hal::Result<> do_start(const hal::HttpRequest& request, hal::Instant now) override {
    return taken(*recorder_, name(), "start", fields_of(request), client_->start(request, now));
  }
  hal::Result<std::optional<hal::HttpResponse>> do_poll(hal::Instant now) override {
    auto answer = client_->poll(now);
    if (answer && !*answer) return answer;
    return taken(*recorder_, name(), "<answer", {}, std::move(answer), [](const auto& response) {
      return hal::Fields{hal::field(response->status), response->body};
    });
  }
  void do_cancel() override {
    client_->cancel();
    recorder_->take(name(), "cancel", {}, hal::Fields{});
  }
  [[nodiscard]] std::string_view do_name() const override { return client_->name(); }

  hal::HttpClient* client_;
  hal::Recorder* recorder_;
};

}  // namespace forager::mocks
