#pragma once

#include <deque>
#include <optional>
#include <string>
#include <string_view>

#include "hal/http_client.hpp"
#include "mocks/scripted_failure.hpp"

namespace forager::mocks {

// A server that expects listed requests in order and gives canned answers. Anything else is reported, and so
// is a script with requests left at destruction.
class ScriptedHttpClient final : public hal::HttpClient {
 public:
  explicit ScriptedHttpClient(std::string name, ScriptFailure on_failure = abort_on_script_failure());
  ~ScriptedHttpClient() override;
  ScriptedHttpClient(const ScriptedHttpClient&) = delete;
  ScriptedHttpClient& operator=(const ScriptedHttpClient&) = delete;

  // The next request; a body left out is not looked at. Followed by answer() or fail(), else 200 and empty.
  ScriptedHttpClient& expect(hal::HttpMethod method, std::string_view path,
                             std::optional<std::string> body = std::nullopt);
  ScriptedHttpClient& answer(int status, std::string_view body);
  ScriptedHttpClient& fail(hal::Error error);
  // Time from start() to the answer, for the requests listed from here on. One that reaches the request's own
  // timeout ends as timeout.
  ScriptedHttpClient& latency(hal::Duration latency);

  [[nodiscard]] bool done() const { return exchanges_.empty(); }
  [[nodiscard]] std::size_t cancelled() const { return cancelled_; }

 private:
  struct Exchange {
    hal::HttpMethod method;
    std::string path;
    std::optional<std::string> body;
    hal::HttpResponse response;
    std::optional<hal::Error> error;
    hal::Duration latency;
  };
  struct InFlight {
    Exchange exchange;
    hal::Instant answer_at;
    hal::Instant timeout_at;
  };

  hal::Result<> do_start(const hal::HttpRequest& request, hal::Instant now) override;
  hal::Result<std::optional<hal::HttpResponse>> do_poll(hal::Instant now) override;
  void do_cancel() override;
  std::string_view do_name() const override { return name_; }
  void check(const Exchange& wanted, const hal::HttpRequest& request);

  std::string name_;
  ScriptFailure on_failure_;
  std::deque<Exchange> exchanges_;
  std::optional<InFlight> in_flight_;
  hal::Duration latency_{};
  std::size_t cancelled_ = 0;
};

}  // namespace forager::mocks
