#pragma once

#include <array>
#include <cstdint>
#include <deque>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "hal/journal.hpp"
#include "hal/random.hpp"
#include "mocks/http_handler.hpp"
#include "mocks/sim_reader_batcher.hpp"
#include "mocks/sim_reader_config.hpp"
#include "mocks/sim_reader_events.hpp"
#include "mocks/sim_reader_settings.hpp"
#include "mocks/sim_reader_streams.hpp"
#include "mocks/sim_reader_values.hpp"
#include "mocks/tag_field.hpp"

namespace forager::mocks {

// A Keonn AdvanReader-160 running AdvanNet, true to the wire. Two faces:
//  - bytes: REST (submit/take for SimHttpClient and HttpServer, handle_http to ask directly) and the event
//    stream (attach lines);
//  - physics: a TagField that it switches on with what was configured over the wire, inputs a test drives,
//    outputs and power a test watches and cuts, and switches for everything that goes wrong in the field.
// Unknown operations, devices, parameters and values are refused as AdvanNet does ("CODE: text" in an
// envelope with status ERROR); what the emulator cannot do is refused too, never answered OK.
//
// Boots at the first call that tells the time; later boots take config.boot_time. Unsaved settings are lost
// at every boot. Equal seeds and calls give equal bytes.
class SimReader final : public HttpHandler {
 public:
  static constexpr int kGpiLines = 4;
  static constexpr int kGpoLines = 10;  // 8 outputs, 9 = relay, 10 = enable of the 5 V supply

  enum class Status : std::uint8_t { shutdown, stopped, running };

  SimReader(SimReaderConfig config, TagField& field, hal::Journal& journal);
  SimReader(const SimReader&) = delete;
  SimReader& operator=(const SimReader&) = delete;

  // Moves the reader on to `now`: air, batches, stream. Call it at least every 10 ms of its time to keep the
  // delays of the device; a coarser step only makes frames later and larger.
  void update(hal::Instant now);

  // --- bytes -------------------------------------------------------------------------------------------
  // One request, answered on the spot; a sweep (SEQUENTIAL /inventory) is answered with an empty `later`.
  struct Answered {
    HttpReply reply;
    bool later = false;  // take the answer from sweep_reply()
  };
  [[nodiscard]] Answered handle_http(hal::HttpMethod method, std::string_view path, std::string_view body,
                                     hal::Instant now);
  [[nodiscard]] std::optional<HttpReply> sweep_reply(hal::Instant now);

  [[nodiscard]] std::uint32_t submit(hal::HttpMethod method, std::string_view path, std::string_view body,
                                     hal::Instant now) override;
  [[nodiscard]] std::optional<HttpReply> take(std::uint32_t request, hal::Instant now) override;
  void forget(std::uint32_t request) override;
  [[nodiscard]] bool knows(std::uint32_t request) const override;
  [[nodiscard]] HttpReach reach(hal::Instant now) override;
  // Powered, booted, and not refusing connects.
  [[nodiscard]] bool reachable(hal::Instant now) { return reach(now) == HttpReach::listening; }

  // Lines to the event stream; see SimReaderStreams.
  [[nodiscard]] SimReaderStreams& streams() { return streams_; }
  [[nodiscard]] const SimReaderStreams& streams() const { return streams_; }

  // --- physics -----------------------------------------------------------------------------------------
  // Input line 1..4; a change is told to the stream clients. Other lines are ignored.
  void set_gpi(int line, bool high, hal::Instant now);
  [[nodiscard]] bool gpo(int line) const;  // 1..10; false for other lines
  void power_cut(hal::Instant now);        // silence: nobody is told, connections hang
  void power_on(hal::Instant now);
  void reboot(hal::Instant now);  // orderly: connections are closed first

  [[nodiscard]] SimReaderFaults& faults() { return config_.faults; }
  [[nodiscard]] const SimReaderConfig& config() const { return config_; }
  [[nodiscard]] Status status() const { return status_; }
  [[nodiscard]] bool radiating() const { return radiating_; }
  [[nodiscard]] bool powered() const { return power_ != SimReaderStreams::Power::off; }
  [[nodiscard]] const SimReaderSettings& settings() const { return settings_; }
  [[nodiscard]] std::int64_t reader_ms(hal::Instant at) const;  // what its clock says
  [[nodiscard]] std::uint64_t reads() const { return reads_; }  // replies heard on the air since construction

 private:
  // What an operation answers: the inside of <data>, or a whole document of its own.
  struct Content {
    std::string text;
    bool whole = false;
    bool later = false;
  };
  struct Call {
    hal::HttpMethod method;
    std::span<const std::string> arguments;  // path segments after the operation
    std::string_view body;
    hal::Instant now;
  };
  using Handler = Answer<Content> (SimReader::*)(const Call&);
  struct Operation;
  struct Job {
    std::uint32_t id;
    hal::HttpMethod method;
    std::string path;
    std::string body;
    hal::Instant due;
    bool started = false;
    bool forgotten = false;
    std::optional<HttpReply> reply;
  };
  struct Sweep {
    std::string operation;
    hal::Instant ends;
    std::vector<SimReadEvent> reads;
  };

  // sim_reader.cpp
  void catch_up(hal::Instant now);
  void boot(hal::Instant now);
  void switch_off(hal::Instant now);
  void begin_boot(hal::Instant now);
  void start_radio(hal::Instant now);
  void stop_radio(hal::Instant now);
  void renew_radio(hal::Instant now);
  void hear(const AirRead& read);
  void work_off_jobs(hal::Instant now);
  void note(hal::Instant now, std::string_view text) { journal_->note(now, config_.name, text); }
  [[nodiscard]] SimReaderEvents::Context context(hal::Instant now) const;

  // sim_reader_rest.cpp: envelopes and the resolution of paths
  [[nodiscard]] Answer<Content> route(std::span<const std::string> path, std::string& op, Call call);
  [[nodiscard]] Answer<Content> route_device(std::span<const std::string> path, std::string& op, Call call);
  [[nodiscard]] Answer<Content> route_system(std::span<const std::string> path, std::string& op, Call call);
  [[nodiscard]] bool refused_by_fault(std::string_view op);
  [[nodiscard]] HttpReply envelope(std::string_view op, Answer<Content> answer, hal::Instant now) const;

  // sim_reader_operations.cpp, sim_reader_report.cpp: what each operation does
  static std::span<const Operation> operations();
  Answer<Content> do_connect(const Call& call);
  Answer<Content> do_start(const Call& call);
  Answer<Content> do_stop(const Call& call);
  Answer<Content> do_shutdown(const Call& call);
  Answer<Content> do_device_modes(const Call& call);
  Answer<Content> do_device_mode(const Call& call);
  Answer<Content> do_read_mode(const Call& call);
  Answer<Content> do_read_modes(const Call& call);
  Answer<Content> do_reader(const Call& call);
  Answer<Content> do_parameter(const Call& call);
  Answer<Content> do_mcu(const Call& call);
  Answer<Content> do_antennas(const Call& call);
  Answer<Content> do_inventory(const Call& call);
  Answer<Content> do_location(const Call& call);
  Answer<Content> do_json_location(const Call& call);
  Answer<Content> do_set_gpo(const Call& call);
  Answer<Content> do_get_gpi(const Call& call);
  Answer<Content> do_gpi_all(const Call& call);
  Answer<Content> do_gpio_all(const Call& call);
  Answer<Content> do_save(const Call& call);
  Answer<Content> access_parameter(const Call& call, SimReaderValue::Group group, std::string_view name);
  Answer<Content> inventory(const Call& call, const char* operation);
  [[nodiscard]] std::string inventory_text(std::string_view operation, std::span<const SimReadEvent> reads,
                                           hal::Instant now);
  [[nodiscard]] std::string device_xml(hal::Instant now) const;
  [[nodiscard]] std::string status_xml(hal::Instant now) const;

  SimReaderConfig config_;
  TagField* field_;
  hal::Journal* journal_;
  SimReaderSettings settings_;
  SimReaderSettings saved_;
  SimReaderStreams streams_;
  SimReaderEvents events_;
  SimReaderBatcher batcher_;
  hal::Random random_;

  SimReaderStreams::Power power_ = SimReaderStreams::Power::booting;
  hal::Instant boot_done_at_ = hal::Instant::min();
  std::optional<hal::Instant> reboot_at_;  // asked for over REST: the answer goes out first
  hal::Instant booted_at_;
  std::int64_t clock_base_ms_ = 0;  // reader clock at booted_at_
  Status status_ = Status::stopped;
  bool radiating_ = false;
  GpiLevels gpi_{};
  std::array<bool, kGpoLines> gpo_{};
  std::uint64_t reads_ = 0;

  std::deque<Job> jobs_;
  std::uint32_t last_job_ = 0;
  std::optional<Sweep> sweep_;
  std::vector<AirRead> air_;
  std::string body_;
};

}  // namespace forager::mocks
