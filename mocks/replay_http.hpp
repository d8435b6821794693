#pragma once

#include <string>

#include "mocks/recording_http.hpp"
#include "mocks/replay.hpp"

namespace forager::mocks {

// An HTTP client as mocks/recording_http.hpp noted it; `name` is that of the recorded one.
class ReplayHttpClient final : public hal::HttpClient {
 public:
  ReplayHttpClient(std::string name, Replay& replay) : name_(std::move(name)), replay_(&replay) {}

 private:
  hal::Result<> do_start(const hal::HttpRequest& request, hal::Instant) override {
    return nothing_of(replay_->call(name_, "start", RecordingHttpClient::fields_of(request)));
  }
  hal::Result<std::optional<hal::HttpResponse>> do_poll(hal::Instant) override {
    const auto answer = replay_->arrived(name_, "<answer");
    if (!answer) return std::optional<hal::HttpResponse>{};
    if (!*answer) return hal::fail(answer->error());
    const auto status = (*answer)->size() == 2 ? hal::integer_in((**answer)[0]) : std::nullopt;
    if (!status) return Replay::broken(name_, "<answer");
    return std::optional(hal::HttpResponse{static_cast<int>(*status), (**answer)[1]});
  }
  void do_cancel() override { static_cast<void>(replay_->call(name_, "cancel", {})); }
  [[nodiscard]] std::string_view do_name() const override { return name_; }

  std::string name_;
  Replay* replay_;
};

}  // namespace forager::mocks
