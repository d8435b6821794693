#pragma once

#include <cstdint>
#include <memory>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "hal/byte_stream.hpp"
#include "hal/http_client.hpp"
#include "hal/journal.hpp"
#include "reader/advannet_events.hpp"
#include "reader/advannet_gpo.hpp"
#include "reader/advannet_rest.hpp"
#include "reader/advannet_stream.hpp"
#include "reader/backoff.hpp"
#include "reader/clock_offset.hpp"
#include "reader/read_plan.hpp"
#include "reader/tag_reader.hpp"

namespace forager::reader {

// Everything the driver waits for has its length here; there are no hidden defaults.
struct AdvanNetConfig {
  std::string device_id;            // which device of the reader; empty: its only one
  hal::Duration request_timeout{};  // each REST exchange, and connecting the event stream
  hal::Duration stream_timeout{};   // silence that counts as a loss; above the 5 s keep-alive period
  hal::Duration status_period{};    // how often to ask a running reader how it is (also keeps the clock)
  hal::Duration backoff_first{};    // wait after the first loss, doubling ...
  hal::Duration backoff_cap{};      // ... up to this
  int request_tries = 2;            // times a request without an answer is sent before that is a loss
  bool read_inputs = false;         // ask for the digital inputs' levels when opening
};
// Errors: invalid_argument naming the field.
[[nodiscard]] hal::Result<> validate(const AdvanNetConfig& config);

struct AdvanNetCounters {
  std::uint64_t inventories = 0;   // messages of reads; each gathers one or several rounds on the air
  std::uint64_t reads = 0;         // handed out
  std::uint64_t stale = 0;         // older than the start, dropped
  std::uint64_t out_of_order = 0;  // older than a read before them (handed out)
  std::uint64_t malformed = 0;     // messages that were not well-formed
  std::uint64_t bad_items = 0;     // items without EPC or time in sound messages
  std::uint64_t unknown = 0;       // messages of unknown kind
  std::uint64_t clock_doubts = 0;  // reads whose time cannot be; taken as heard on arrival
  std::uint64_t requests = 0;      // REST, repeats included
  std::uint64_t repeats = 0;
  std::uint64_t reconnects = 0;  // times the link opened again
  std::uint64_t configured = 0;  // times the whole plan was written
};

// Drives a Keonn AdvanReader through AdvanNet: REST for the plan, the event stream for the reads. What
// happens in which step, and what follows:
//
//   step        does                                     then
//   closed      nothing                                  start() -> discover
//   discover    GET /devices; picks the device           one or the named device -> uptime; none -> waiting;
//                                                        several, none named -> failed
//   uptime      GET /status (no answer is fine)          settings known to be in place and RUNNING -> verify;
//                                                        SHUTDOWN -> connect; else -> stop
//   connect     GET connect                              stop
//   stop        GET stop                                 mode
//   mode        PUT activeDeviceMode Autonomous          read_mode
//   read_mode   PUT readModes[0]: RF on and off time     antennas
//   antennas    PUT antennas: the plan's ports           parameters
//   parameters  PUT power, sensitivity, session, ...     verify
//   verify      GET power, session, target; compares     same -> outputs; differs after writing -> failed;
//                                                        differs after a loss -> stop (write all again)
//   outputs     GET DATA_GPO_NUMBER, if gpo() was used   inputs
//   inputs      GET getGPIAll, if config.read_inputs     stream
//   stream      connects the event stream                was running on -> open; else -> start
//   start       GET start; its <ts> is the stale limit   open
//   open        reads; GET /devices/{id} now and then    silence, disconnect, not RUNNING -> waiting
//   waiting     back-off                                 discover
//   ending      outputs inactive, GET stop               closed, or failed
//   failed      nothing: a person must act               start()
//
// The stream opens before the start, so no read is missed. A request without an answer is repeated
// request_tries times, then the link is lost. An ERROR that says the plan is wrong (PARAMETER_ERROR,
// UNKNOWN_OPERATION, ...), a wrong password, or settings that do not read back fail the link; other ERRORs
// are losses. After a loss the reader is asked whether it is still RUNNING with our settings; if it is not,
// if it restarted, or if REST did not answer meanwhile, the whole plan is written again.
//
// Reads are stamped twice: on arrival, and by the reader's clock moved to our time line (ClockOffset). A
// reader time that cannot be (ahead of arrival, or a minute behind it) makes the driver look at the clock at
// once and take the arrival instead.
//
// update() in the open step allocates nothing while frames arrive; REST exchanges do.
class AdvanNetReader final : public TagReader {
 public:
  // All references must outlive the reader. rest and events are the driver's alone.
  AdvanNetReader(hal::HttpClient& rest, hal::ByteStream& events, hal::Journal& journal, ReadPlan plan,
                 AdvanNetConfig config);

  void start(hal::Instant now) override;
  void update(hal::Instant now) override;
  [[nodiscard]] std::span<const TagRead> reads() const override { return reads_; }
  [[nodiscard]] const LinkStatus& link() const override { return link_; }
  // As stop(), at the time of the last update(), and sends the stop request before it returns if it can.
  void halt() noexcept override;
  // Outputs inactive, radio off, stream closed; driven on by update() until idle().
  void stop(hal::Instant now);
  // Nothing is under way or owed to the reader (closed or failed).
  [[nodiscard]] bool idle() const { return step_ == Step::closed || step_ == Step::failed; }
  // The reader was running, or told to run, and has not confirmed a stop since.
  [[nodiscard]] bool may_radiate() const { return may_radiate_; }

  // Input changes taken in by the last update(); with read_inputs also the levels found when opening.
  [[nodiscard]] std::span<const GpiEvent> inputs() const { return inputs_; }
  // A digital output; the same line gives the same object, which lives as long as the reader.
  [[nodiscard]] hal::DigitalOut& gpo(std::uint8_t line);

  [[nodiscard]] const AdvanNetCounters& counters() const { return counters_; }
  [[nodiscard]] const AdvanNetStreamCounters& stream_counters() const { return stream_.counters(); }
  [[nodiscard]] const ClockOffset& clock() const { return clock_; }
  [[nodiscard]] const advannet::Device& device() const { return device_; }  // empty until discovered

 private:
  enum class Step : std::uint8_t {
    closed,
    discover,
    uptime,
    connect,
    stop,
    mode,
    read_mode,
    antennas,
    parameters,
    verify,
    outputs,
    inputs,
    stream,
    start,
    open,
    waiting,
    ending,
    failed,
  };
  enum class Call : std::uint8_t { none, step, check, gpo };

  // advannet_reader.cpp: the loop, the stream, the link
  void set_phase(LinkPhase phase, std::string reason);
  void lose(std::string reason);
  void fail_link(std::string reason);
  void shut_down(std::string reason, Step afterwards);
  void drop_connections();
  void take_in();
  void take_frames();
  void take_message();
  bool accept(TagRead& read);
  void connect_stream();
  void open_link();
  [[nodiscard]] std::uint64_t frames() const;  // so far, keep-alives included
  void end();
  void watch();

  // advannet_calls.cpp: one request at a time, its repeats and its end
  void poll_rest();
  void send_due();
  void send(Call call, hal::HttpRequest request);
  void on_no_answer(const hal::Error& error);
  void on_reply(const advannet::Reply& reply);
  void learn_time(const advannet::Reply& reply);
  void on_gpo(const advannet::Reply& reply);
  [[nodiscard]] AdvanNetGpo* unsettled_gpo();
  [[nodiscard]] std::string blame(std::string detail, std::string mend) const;

  // advannet_steps.cpp: what each step asks for, and what its answer means
  void go(Step step);
  [[nodiscard]] std::optional<hal::HttpRequest> request_of_step() const;
  void on_step_done(const advannet::Reply& reply);
  void on_step_refused(const advannet::Reply& reply);
  void on_devices(const advannet::Reply& reply);
  void on_uptime(const advannet::Reply& reply);
  [[nodiscard]] bool on_verified(const advannet::Reply& reply);
  void on_check(const advannet::Reply& reply);

  hal::HttpClient& rest_;
  hal::ByteStream& events_;
  hal::Journal& journal_;
  ReadPlan plan_;
  AdvanNetConfig config_;
  std::vector<advannet::Setting> settings_;

  hal::Instant now_;
  Step step_ = Step::closed;
  Step after_ending_ = Step::closed;
  LinkStatus link_;
  AdvanNetCounters counters_;
  Backoff backoff_;
  hal::Deadline wait_;
  advannet::Device device_;

  Call call_ = Call::none;    // the request in flight
  Call repeat_ = Call::none;  // request_ is to be sent again
  hal::HttpRequest request_;  // kept for repeats and for naming it
  hal::Instant sent_;
  int tries_ = 0;
  AdvanNetGpo* gpo_call_ = nullptr;
  bool gpo_level_ = false;

  std::size_t index_ = 0;           // setting being written or verified
  bool settings_in_place_ = false;  // written since the reader last could have lost them
  bool writing_all_ = true;         // this opening writes the plan, rather than checking it
  bool may_radiate_ = false;        // the reader was running, or told to, and not told to stop since
  bool stop_owed_ = false;          // ending, and the stop is not answered yet
  bool was_open_ = false;
  bool check_now_ = false;
  hal::Instant last_check_;
  std::optional<hal::Instant> booted_;

  AdvanNetStream stream_;
  AdvanNetMessage message_;
  bool stream_live_ = false;
  hal::Instant stream_heard_;  // last whole frame of the event stream, or its opening
  bool noise_ = false;         // bytes have come since, but no frame
  std::vector<TagRead> reads_;
  std::vector<GpiEvent> inputs_;
  ClockOffset clock_;
  std::optional<std::int64_t> start_ms_;  // reader clock at the start: older reads are stale
  hal::Instant started_;
  std::int64_t newest_ms_ = 0;
  std::vector<std::unique_ptr<AdvanNetGpo>> gpos_;
};

}  // namespace forager::reader
