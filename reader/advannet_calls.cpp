#include <fmt/format.h>

#include <algorithm>
#include <utility>

#include "reader/advannet_reader.hpp"

namespace forager::reader {
namespace {

using namespace std::chrono_literals;

constexpr std::string_view kSource = "reader";
constexpr hal::Duration kMinCheckGap = 1s;   // between status requests that reads gave rise to
constexpr std::int64_t kClockBackMs = 1000;  // a clock set back by more: more likely a restart

bool worth_repeating(hal::ErrorCode code) {
  return code == hal::ErrorCode::timeout || code == hal::ErrorCode::disconnected ||
         code == hal::ErrorCode::protocol || code == hal::ErrorCode::io;
}

}  // namespace

std::string AdvanNetReader::blame(std::string detail, std::string mend) const {
  return hal::describe({hal::ErrorCode::io,
                        device_.id.empty() ? fmt::format("AdvanReader at {}", rest_.name())
                                           : fmt::format("AdvanReader {} at {}", device_.id, rest_.name()),
                        advannet::describe_request(request_), std::move(detail), std::move(mend)});
}

hal::DigitalOut& AdvanNetReader::gpo(std::uint8_t line) {
  const auto known = std::ranges::find_if(gpos_, [line](const auto& gpo) { return gpo->line() == line; });
  if (known != gpos_.end()) return **known;
  gpos_.push_back(std::make_unique<AdvanNetGpo>(line));
  return *gpos_.back();
}

AdvanNetGpo* AdvanNetReader::unsettled_gpo() {
  const auto found = std::ranges::find_if(gpos_, [](const auto& gpo) { return !gpo->settled(); });
  return found == gpos_.end() ? nullptr : found->get();
}

// One request at a time. The radio goes off before the outputs; otherwise outputs go first, they are few and
// somebody waits for them.
void AdvanNetReader::send_due() {
  if (call_ != Call::none) return;
  if (repeat_ != Call::none) {
    send(std::exchange(repeat_, Call::none), std::move(request_));
    return;
  }
  const bool device_known = step_ != Step::closed && step_ != Step::discover && step_ != Step::uptime &&
                            step_ != Step::waiting && step_ != Step::failed;
  AdvanNetGpo* const gpo = device_known && !(step_ == Step::ending && stop_owed_) ? unsettled_gpo() : nullptr;
  if (gpo != nullptr) {
    gpo_call_ = gpo;
    gpo_level_ = gpo->wanted();
    send(Call::gpo, advannet::set_gpo(device_.id, gpo->line(), gpo_level_));
  } else if (auto request = request_of_step()) {
    send(Call::step, std::move(*request));
  } else if (step_ == Step::ending) {
    end();
  } else if (step_ == Step::open &&
             now_ - last_check_ >=
                 (check_now_ ? std::min(kMinCheckGap, config_.status_period) : config_.status_period)) {
    last_check_ = now_;
    check_now_ = false;
    send(Call::check, advannet::get_device(device_.id));
  }
}

void AdvanNetReader::send(Call call, hal::HttpRequest request) {
  request_ = std::move(request);
  request_.timeout = config_.request_timeout;
  const auto started = rest_.start(request_, now_);
  if (!started && started.error().code == hal::ErrorCode::busy) {
    repeat_ = call;  // the client still winds up what was cancelled
    return;
  }
  ++counters_.requests;
  ++tries_;
  call_ = call;
  sent_ = now_;
  if (step_ == Step::start) may_radiate_ = true;  // it may arrive even if no answer comes back
  if (!started) on_no_answer(started.error());
}

void AdvanNetReader::poll_rest() {
  if (call_ == Call::none) return;
  const auto response = rest_.poll(now_);
  if (!response) {
    on_no_answer(response.error());
  } else if (*response) {
    const auto reply = advannet::parse_reply(**response);
    if (reply)
      on_reply(*reply);
    else
      on_no_answer(reply.error());
  } else if (now_ - sent_ >= config_.request_timeout) {
    rest_.cancel();
    on_no_answer({hal::ErrorCode::timeout, {}, {}, "no answer in time", {}});
  }
}

void AdvanNetReader::on_no_answer(const hal::Error& error) {
  const Call call = std::exchange(call_, Call::none);
  if (worth_repeating(error.code) && tries_ < config_.request_tries) {
    ++counters_.repeats;
    repeat_ = call;
    return;
  }
  const int tries = std::exchange(tries_, 0);
  const std::string detail =
      fmt::format("{} (tried {} time{})", error.detail.empty() ? to_string(error.code) : error.detail, tries,
                  tries == 1 ? "" : "s");
  const std::string mend = error.mend.empty() ? "Check the reader's power and the network" : error.mend;
  if (error.code == hal::ErrorCode::refused) settings_in_place_ = false;  // the server is down: it restarts
  if (call == Call::gpo) gpo_call_->reject(gpo_level_, error);
  if (step_ == Step::ending) {
    journal_.note(now_, kSource, blame(detail, mend));
    stop_owed_ = stop_owed_ && call != Call::step;
  } else if (error.code == hal::ErrorCode::authentication) {
    fail_link(blame(detail, "Set the reader's user and password in the board file"));
  } else if (error.code == hal::ErrorCode::unsupported || error.code == hal::ErrorCode::invalid_argument) {
    fail_link(blame(detail, mend));
  } else if (call != Call::step) {
    journal_.note(now_, kSource, blame(detail, mend));  // the event stream tells whether the reader lives
  } else if (error.code == hal::ErrorCode::protocol &&
             (step_ == Step::uptime || step_ == Step::outputs || step_ == Step::inputs)) {
    on_step_done({});  // nice to know, not needed
  } else {
    settings_in_place_ = false;
    lose(blame(detail, mend));
  }
}

void AdvanNetReader::on_reply(const advannet::Reply& reply) {
  const Call call = std::exchange(call_, Call::none);
  tries_ = 0;
  link_.last_heard = now_;
  learn_time(reply);
  if (call == Call::gpo)
    on_gpo(reply);
  else if (call == Call::check)
    on_check(reply);
  else if (reply.ok)
    on_step_done(reply);
  else
    on_step_refused(reply);
}

void AdvanNetReader::learn_time(const advannet::Reply& reply) {
  if (!reply.ts_ms || clock_.add(sent_, now_, *reply.ts_ms) != ClockOffset::Outcome::stepped) return;
  const std::int64_t step_ms = clock_.last_step_ms();
  journal_.note(now_, kSource,
                fmt::format("the reader's clock was set by {:+.3f} s", static_cast<double>(step_ms) * 1e-3));
  if (start_ms_) *start_ms_ += step_ms;
  newest_ms_ = 0;
  if (step_ != Step::open && step_ms < -kClockBackMs) settings_in_place_ = false;
}

void AdvanNetReader::on_gpo(const advannet::Reply& reply) {
  if (reply.ok) {
    gpo_call_->confirm(gpo_level_);
    return;
  }
  const std::string mend = "Check the line number; DATA_GPO_NUMBER says how many the reader has";
  journal_.note(now_, kSource, blame(advannet::describe_refusal(reply), mend));
  gpo_call_->reject(
      gpo_level_,
      {reply.code == advannet::kInvalidGpoNumber ? hal::ErrorCode::invalid_argument : hal::ErrorCode::refused,
       fmt::format("AdvanReader {}", device_.id), advannet::describe_request(request_),
       advannet::describe_refusal(reply), mend});
}

}  // namespace forager::reader
