#include <fmt/format.h>

#include <algorithm>
#include <array>

#include "reader/advannet_reader.hpp"

namespace forager::reader {
namespace {

using namespace std::chrono_literals;

constexpr std::string_view kSource = "reader";
constexpr hal::Duration kRestartMargin = 5s;  // uptimes are whole seconds and travel a while

// Answers that trying again does not change: the plan, the firmware or the account is wrong.
bool is_final(std::string_view code) {
  constexpr std::array<std::string_view, 10> kFinal{
      advannet::kParameterError,  advannet::kUnknownOperation,   advannet::kInvalidTarget,
      advannet::kInvalidRequest,  advannet::kInvalidParams,      advannet::kInvalidUser,
      advannet::kInvalidReadMode, advannet::kConfigurationError, advannet::kReadModeNotConfigured,
      advannet::kNoSuchDeviceMode};
  return std::ranges::find(kFinal, code) != kFinal.end();
}

}  // namespace

void AdvanNetReader::go(Step step) {
  step_ = step;
  index_ = 0;
  if (step == Step::discover) writing_all_ = !settings_in_place_;
  if (step != Step::stream) return;
  wait_ = hal::Deadline(now_, config_.request_timeout);
  if (const auto opened = events_.open(); !opened)
    lose(hal::describe({opened.error().code,
                        std::string(events_.name()),
                        "connect event stream",
                        describe(opened.error()),
                        {}}));
}

std::optional<hal::HttpRequest> AdvanNetReader::request_of_step() const {
  const std::string& id = device_.id;
  switch (step_) {
    case Step::discover:
      return advannet::get_devices();
    case Step::uptime:
      return advannet::get_status();
    case Step::connect:
      return advannet::get_operation(id, "connect");
    case Step::stop:
      return advannet::get_operation(id, "stop");
    case Step::mode:
      return advannet::put_device_mode(id, advannet::kModeAutonomous);
    case Step::read_mode:
      return advannet::put_read_mode(id, plan_);
    case Step::antennas:
      return advannet::put_antennas(id, plan_);
    case Step::parameters:
      return advannet::put_parameter(id, settings_[index_].name, settings_[index_].value);
    case Step::verify:
      return advannet::get_parameter(id, settings_[index_].name);
    case Step::outputs:
      return advannet::get_parameter(id, advannet::kGpoNumber);
    case Step::inputs:
      return advannet::get_operation(id, "getGPIAll");
    case Step::start:
      return advannet::get_operation(id, "start");
    case Step::ending:
      if (stop_owed_) return advannet::get_operation(id, "stop");
      return std::nullopt;
    case Step::closed:
    case Step::stream:
    case Step::open:
    case Step::waiting:
    case Step::failed:
      return std::nullopt;
  }
  return std::nullopt;
}

void AdvanNetReader::on_step_refused(const advannet::Reply& reply) {
  if (step_ == Step::ending) {
    journal_.note(now_, kSource, blame(advannet::describe_refusal(reply), {}));
    stop_owed_ = false;
  } else if (step_ == Step::uptime || step_ == Step::outputs || step_ == Step::inputs) {
    on_step_done({});  // nice to know, not needed
  } else if (!is_final(reply.code)) {
    settings_in_place_ = false;
    lose(
        blame(advannet::describe_refusal(reply), "Trying again; if it stays, look at the reader's web page"));
  } else if (step_ == Step::parameters || step_ == Step::verify) {
    fail_link(blame(advannet::describe_refusal(reply),
                    fmt::format("Change [reader] {} to what this reader can do", settings_[index_].key)));
  } else if (step_ == Step::antennas || step_ == Step::read_mode) {
    fail_link(blame(advannet::describe_refusal(reply),
                    step_ == Step::antennas
                        ? "Change [reader] ports to what this reader has"
                        : "Change [reader] on_time and off_time to what this reader can do"));
  } else {
    fail_link(
        blame(advannet::describe_refusal(reply), "This reader's firmware cannot do what the driver needs"));
  }
}

void AdvanNetReader::on_step_done(const advannet::Reply& reply) {
  const Step after_verify = !gpos_.empty()        ? Step::outputs
                            : config_.read_inputs ? Step::inputs
                                                  : Step::stream;
  switch (step_) {
    case Step::discover:
      return on_devices(reply);
    case Step::uptime:
      return on_uptime(reply);
    case Step::connect:
      return go(Step::stop);
    case Step::stop:
      may_radiate_ = false;
      return go(Step::mode);
    case Step::mode:
      return go(Step::read_mode);
    case Step::read_mode:
      return go(Step::antennas);
    case Step::antennas:
      return go(Step::parameters);
    case Step::parameters:
      if (++index_ == settings_.size()) go(Step::verify);
      return;
    case Step::verify:
      if (on_verified(reply)) go(after_verify);
      return;
    case Step::outputs:
      // A relay or a buzzer may count beyond, so this is for the person who wonders, not a verdict.
      if (reply.result)
        journal_.note(now_, kSource, fmt::format("the reader has {} digital outputs", *reply.result));
      return go(config_.read_inputs ? Step::inputs : Step::stream);
    case Step::inputs:
      for (const advannet::InputLevel& input : reply.inputs)
        inputs_.push_back({static_cast<std::uint8_t>(input.line), input.high, reply.ts_ms.value_or(0)});
      return go(Step::stream);
    case Step::start:
      ++counters_.configured;
      start_ms_ = reply.ts_ms;
      if (!start_ms_ && clock_.known()) start_ms_ = clock_.to_reader_ms(sent_);
      started_ = now_;
      newest_ms_ = 0;
      return open_link();
    case Step::ending:
      stop_owed_ = may_radiate_ = false;
      return;
    case Step::closed:
    case Step::stream:
    case Step::open:
    case Step::waiting:
    case Step::failed:
      return;
  }
}

void AdvanNetReader::on_devices(const advannet::Reply& reply) {
  const auto& devices = reply.devices;
  const std::string& wanted = config_.device_id;
  std::string ids;
  for (const auto& device : devices) ids += (ids.empty() ? "" : ", ") + device.id;
  if (devices.empty()) {
    settings_in_place_ = false;
    return lose(blame("the reader lists no device", "It may still be starting; look at its web page"));
  }
  const auto chosen =
      wanted.empty() ? devices.begin() : std::ranges::find(devices, wanted, &advannet::Device::id);
  if (chosen == devices.end())
    return fail_link(blame(fmt::format("no device '{}', there is: {}", wanted, ids),
                           "Set [reader] device to one of them"));
  if (wanted.empty() && devices.size() > 1)
    return fail_link(blame(fmt::format("there are {} devices: {}", devices.size(), ids),
                           "Set [reader] device to one of them"));
  if (!device_.id.empty() && (device_.id != chosen->id || device_.serial != chosen->serial))
    settings_in_place_ = false;  // somebody exchanged the reader
  device_ = *chosen;
  if (device_.status == advannet::kStatusRunning) may_radiate_ = true;
  go(Step::uptime);
}

void AdvanNetReader::on_uptime(const advannet::Reply& reply) {
  if (reply.uptime) {
    const hal::Instant booted = now_ - *reply.uptime;
    if (booted_ && booted > *booted_ + kRestartMargin) {
      journal_.note(now_, kSource, "the reader was restarted: its settings are written again");
      settings_in_place_ = false;
    }
    booted_ = booted;
  }
  writing_all_ = !settings_in_place_ || device_.status != advannet::kStatusRunning;
  if (!writing_all_) return go(Step::verify);
  settings_in_place_ = false;
  for (const auto& gpo : gpos_) gpo->forget();
  go(device_.status == advannet::kStatusShutdown ? Step::connect : Step::stop);
}

// True when the last of the settings has read back well.
bool AdvanNetReader::on_verified(const advannet::Reply& reply) {
  const advannet::Setting& setting = settings_[index_];
  if (!reply.result || !advannet::same_value(setting.value, *reply.result)) {
    const std::string found = reply.result.value_or("nothing");
    if (writing_all_) {
      fail_link(blame(fmt::format("reads back {} after {} was written", found, setting.value),
                      fmt::format("Change [reader] {} to what this reader can do", setting.key)));
    } else {
      journal_.note(now_, kSource,
                    fmt::format("{} reads {}: the reader's settings are written again", setting.name, found));
      writing_all_ = true;
      settings_in_place_ = false;
      go(Step::stop);
    }
    return false;
  }
  do ++index_;
  while (index_ < settings_.size() && !settings_[index_].read_back);
  return index_ == settings_.size();
}

void AdvanNetReader::on_check(const advannet::Reply& reply) {
  if (step_ != Step::open) return;
  if (!reply.ok) {
    if (reply.code == advannet::kUnknownDevice) {
      settings_in_place_ = false;
      lose(blame(advannet::describe_refusal(reply), "Looking for the reader's device again"));
    } else {
      journal_.note(now_, kSource, blame(advannet::describe_refusal(reply), {}));
    }
    return;
  }
  const auto ours = std::ranges::find(reply.devices, device_.id, &advannet::Device::id);
  if (ours == reply.devices.end() || ours->status.empty()) return;
  device_.status = ours->status;
  if (device_.status == advannet::kStatusRunning) return;
  settings_in_place_ = false;
  lose(blame(fmt::format("the reader reports {}", device_.status),
             "Somebody stopped it, or it restarted; it is set up and started again"));
}

}  // namespace forager::reader
