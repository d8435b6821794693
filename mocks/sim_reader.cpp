#include "mocks/sim_reader.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

namespace forager::mocks {
namespace {

using Power = SimReaderStreams::Power;

}  // namespace

SimReader::SimReader(SimReaderConfig config, TagField& field, hal::Journal& journal)
    : config_(std::move(config)),
      field_(&field),
      journal_(&journal),
      settings_(config_.device_id, config_.ports, config_.autostart),
      saved_(settings_),
      streams_(config_, config_.faults, journal),
      events_(config_),
      batcher_(config_.faults, config_.seed),
      random_(hal::Random::stream(config_.seed, 2)) {}

std::int64_t SimReader::reader_ms(hal::Instant at) const {
  const hal::Duration up = at - booted_at_;
  const auto ms = std::chrono::floor<std::chrono::milliseconds>(up).count();
  if (config_.clock_drift_ppm == 0.0) return clock_base_ms_ + ms;
  return clock_base_ms_ + ms +
         static_cast<std::int64_t>(std::floor(static_cast<double>(ms) * config_.clock_drift_ppm * 1e-6));
}

void SimReader::update(hal::Instant now) {
  catch_up(now);
  work_off_jobs(now);
  if (power_ == Power::on) {
    const auto batch = batcher_.take_due(now);
    if (!batch.empty() && streams_.clients() > 0) {
      body_.clear();
      events_.append_inventory(body_, batch, *field_, context(now));
      streams_.broadcast(body_);
    }
  }
  streams_.update(now);
}

// Brings air and boot up to `now`, so that whatever happens next happens to the reader of this moment.
void SimReader::catch_up(hal::Instant now) {
  if (power_ == Power::booting && now >= boot_done_at_) boot(now);
  if (reboot_at_ && now >= *reboot_at_) return reboot(now);
  if (!radiating_) return;
  const bool sweeping = sweep_.has_value();
  air_.clear();
  field_->advance(now, air_);
  for (const AirRead& read : air_) hear(read);
  if (sweeping && now >= sweep_->ends) stop_radio(now);
}

void SimReader::hear(const AirRead& read) {
  ++reads_;
  const std::int64_t ms = reader_ms(read.at);
  if (sweep_) {
    if (read.at <= sweep_->ends) sweep_->reads.push_back({read, ms});
  } else {
    batcher_.add(read, ms, std::chrono::milliseconds(settings_.read_mode_ms("timeWindow")));
  }
}

void SimReader::boot(hal::Instant now) {
  power_ = Power::on;
  streams_.set_power(power_, now);
  settings_ = saved_;
  booted_at_ = now;
  clock_base_ms_ = config_.faults.clock_at_boot_ms.value_or(config_.clock_at_boot_ms);
  gpo_ = {};
  status_ = Status::stopped;
  batcher_.reset();
  note(now, fmt::format("up, clock {}", clock_base_ms_));
  if (settings_.parameter("DEVICE_RUNTIME_AUTOSTART").value_or("false") == "true") {
    status_ = Status::running;
    if (!settings_.sequential()) start_radio(now);
  }
}

void SimReader::start_radio(hal::Instant now) {
  radiating_ = true;
  field_->radio_on(settings_.radio(), now);
  batcher_.started(reader_ms(now));
}

void SimReader::stop_radio(hal::Instant now) {
  if (!radiating_) return;
  radiating_ = false;
  field_->radio_off(now);
}

// Settings changed under a running reader: the radio module takes them at its next cycle.
void SimReader::renew_radio(hal::Instant now) {
  if (status_ != Status::running || sweep_) return;
  stop_radio(now);
  if (settings_.sequential()) return;
  radiating_ = true;
  field_->radio_on(settings_.radio(), now);
}

void SimReader::switch_off(hal::Instant now) {
  reboot_at_.reset();
  catch_up(now);
  stop_radio(now);
  status_ = Status::shutdown;
  sweep_.reset();
  jobs_.clear();
  batcher_.reset();
  gpo_ = {};
}

void SimReader::begin_boot(hal::Instant now) {
  power_ = Power::booting;
  boot_done_at_ = now + config_.boot_time;
  streams_.set_power(power_, now);
}

void SimReader::power_cut(hal::Instant now) {
  switch_off(now);
  power_ = Power::off;
  streams_.set_power(power_, now);
  note(now, "power cut");
}

void SimReader::power_on(hal::Instant now) {
  if (power_ != Power::off) return;
  note(now, "power on");
  begin_boot(now);
}

void SimReader::reboot(hal::Instant now) {
  if (power_ == Power::off) return;
  switch_off(now);
  note(now, "reboot");
  begin_boot(now);
}

HttpReach SimReader::reach(hal::Instant now) {
  catch_up(now);
  if (power_ == Power::off) return HttpReach::silent;
  return power_ == Power::on && !config_.faults.refuse_connects ? HttpReach::listening : HttpReach::refusing;
}

SimReaderEvents::Context SimReader::context(hal::Instant now) const {
  SimReaderEvents::Context context;
  context.now_ms = reader_ms(now);
  context.gpi = gpi_;
  context.upper_case_epc = config_.faults.upper_case_epc;
  return context;
}

void SimReader::set_gpi(int line, bool high, hal::Instant now) {
  catch_up(now);
  if (line < 1 || line > kGpiLines) return;
  bool& level = gpi_[static_cast<std::size_t>(line - 1)];
  if (level == high) return;
  level = high;
  note(now, fmt::format("GPI {} {}", line, high ? "high" : "low"));
  if (power_ != Power::on || settings_.parameter("MCU_GPI_NOTIFICATION_ENABLE").value_or("false") != "true")
    return;
  body_.clear();
  events_.append_gpi(body_, line, high, reader_ms(now));
  streams_.broadcast(body_);
}

bool SimReader::gpo(int line) const {
  return line >= 1 && line <= kGpoLines && gpo_[static_cast<std::size_t>(line - 1)];
}

std::uint32_t SimReader::submit(hal::HttpMethod method, std::string_view path, std::string_view body,
                                hal::Instant now) {
  catch_up(now);
  if (power_ != Power::on) return ++last_job_;  // lost: knows() says so
  const hal::Instant free = jobs_.empty() ? now : std::max(now, jobs_.back().due);
  jobs_.push_back({++last_job_, method, std::string(path), std::string(body),
                   free + config_.faults.rest_delay, false, false, std::nullopt});
  return last_job_;
}

// One at a time, in order: a request starts when the one before it has its answer.
void SimReader::work_off_jobs(hal::Instant now) {
  for (Job& job : jobs_) {
    if (job.reply) continue;
    if (now < job.due) return;
    if (!job.started) {
      job.started = true;
      Answered answered = handle_http(job.method, job.path, job.body, now);
      if (!answered.later) job.reply = std::move(answered.reply);
    }
    if (!job.reply) job.reply = sweep_reply(now);
    if (!job.reply) return;
  }
  std::erase_if(jobs_, [](const Job& job) { return job.forgotten && job.reply; });
}

std::optional<HttpReply> SimReader::take(std::uint32_t request, hal::Instant now) {
  catch_up(now);
  work_off_jobs(now);
  for (auto job = jobs_.begin(); job != jobs_.end(); ++job)
    if (job->id == request && job->reply) {
      HttpReply reply = std::move(*job->reply);
      jobs_.erase(job);
      return reply;
    }
  return std::nullopt;
}

void SimReader::forget(std::uint32_t request) {
  for (Job& job : jobs_)
    if (job.id == request) job.forgotten = true;
}

bool SimReader::knows(std::uint32_t request) const {
  return std::ranges::any_of(jobs_, [request](const Job& job) { return job.id == request; });
}

}  // namespace forager::mocks
