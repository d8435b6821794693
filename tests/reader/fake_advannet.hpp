#pragma once

#include <cstdint>
#include <functional>
#include <map>
#include <optional>
#include <string>
#include <vector>

#include "hal/http_client.hpp"
#include "mocks/memory_stream.hpp"

namespace forager::test {

// The least that answers an AdvanNetReader: state to poke and read. What a real reader does is the emulator's
// business; this one does what a test tells it to.
class FakeAdvanNet final : public hal::HttpClient {
 public:
  FakeAdvanNet();

  // --- what it is ---
  std::string status = "STOPPED";
  std::map<std::string, std::string> parameters;  // what GET reader/parameter/... answers
  std::vector<std::string> ids{"AdvanReader-m4-160"};
  std::int64_t clock_ms = 1'779'868'340'000;                    // reader clock at instant 0
  std::optional<hal::Duration> booted = hal::Duration::zero();  // uptime counts from here; nullopt: not told
  hal::Duration latency = std::chrono::milliseconds(5);

  // --- what goes wrong ---
  bool down = false;    // refused
  bool silent = false;  // no answer at all
  bool wrong_password = false;
  std::map<std::string, std::string> errors;     // last path segment -> <msg> of an ERROR
  std::map<std::string, std::string> read_back;  // parameter -> what it reads, whatever was written

  // --- what it saw ---
  std::vector<std::string> requests;  // "GET start", "PUT GEN2_SESSION S1"
  [[nodiscard]] std::size_t count(std::string_view request) const;
  bool overlapped = false;  // two requests at once
  std::map<int, bool> outputs;

  // Power-cycle: settings and outputs gone, stream cut.
  void reboot(hal::Instant now);
  // Sends a frame if somebody is connected.
  void send(std::string_view bytes);
  [[nodiscard]] std::int64_t ms(hal::Instant at) const { return clock_ms + hal::to_milliseconds(at); }

  mocks::MemoryStreamPair wire{"tcp 192.168.1.50:3177", mocks::MemoryStreamKind::bytes, 1U << 20U};

 private:
  hal::Result<> do_start(const hal::HttpRequest& request, hal::Instant now) override;
  hal::Result<std::optional<hal::HttpResponse>> do_poll(hal::Instant now) override;
  void do_cancel() override { pending_.reset(); }
  std::string_view do_name() const override { return "192.168.1.50:3161"; }
  [[nodiscard]] std::string answer(const hal::HttpRequest& request, hal::Instant now);
  [[nodiscard]] std::string devices() const;

  struct Pending {
    hal::HttpRequest request;
    hal::Instant sent;
  };
  std::optional<Pending> pending_;
};

}  // namespace forager::test
