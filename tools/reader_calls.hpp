#pragma once

#include "boards/reader_bench.hpp"
#include "hal/error.hpp"
#include "hal/http_client.hpp"
#include "hal/time.hpp"
#include "reader/advannet_rest.hpp"

namespace forager::tools {

// Asks a reader one thing after the other and waits for the answers: for commands that do no more than that.
class ReaderCalls {
 public:
  ReaderCalls(boards::ReaderBench& bench, hal::Clock& clock, hal::Duration timeout)
      : bench_(bench), clock_(clock), timeout_(timeout) {}

  // The reader's answer, which may be a refusal. Errors: those of hal::HttpClient, protocol, timeout;
  // invalid_state after a stop signal.
  [[nodiscard]] hal::Result<reader::advannet::Reply> ask(hal::HttpRequest request);
  // The same, and a refusal is an error (refused).
  [[nodiscard]] hal::Result<reader::advannet::Reply> demand(const hal::HttpRequest& request);
  // The device to talk to: the named one, or the only one. Errors: those of demand(); not_present;
  // invalid_argument (several, none named).
  [[nodiscard]] hal::Result<reader::advannet::Device> find_device(const std::string& wanted);

  // Waits, and lets an emulated reader live.
  void wait(hal::Duration time);

 private:
  [[nodiscard]] hal::Error blame(const hal::HttpRequest& request, hal::Error error) const;

  boards::ReaderBench& bench_;
  hal::Clock& clock_;
  hal::Duration timeout_;
};

}  // namespace forager::tools
