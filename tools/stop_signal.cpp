#include "tools/stop_signal.hpp"

#include <csignal>

namespace forager::tools {
namespace {

constexpr int kSignals[] = {SIGINT, SIGTERM, SIGHUP};
volatile std::sig_atomic_t caught = 0;

void on_signal(int number) {
  if (caught != 0) {
    std::signal(number, SIG_DFL);
    std::raise(number);
    return;
  }
  caught = number;
}

// Under nohup the end of the terminal session is not to end the program.
bool kept_ignored(int number) {
  struct sigaction before {};
  return number == SIGHUP && sigaction(number, nullptr, &before) == 0 && before.sa_handler == SIG_IGN;
}

}  // namespace

StopSignal::StopSignal() {
  caught = 0;
  struct sigaction action {};
  action.sa_handler = on_signal;
  sigemptyset(&action.sa_mask);
  for (const int number : kSignals)
    if (!kept_ignored(number)) sigaction(number, &action, nullptr);
}

StopSignal::~StopSignal() {
  for (const int number : kSignals)
    if (!kept_ignored(number)) std::signal(number, SIG_DFL);
}

bool StopSignal::raised() { return caught != 0; }

void StopSignal::forget() { caught = 0; }

const char* StopSignal::name() {
  switch (caught) {
    case SIGINT:
      return "SIGINT";
    case SIGTERM:
      return "SIGTERM";
    case SIGHUP:
      return "SIGHUP";
    default:
      return "";
  }
}

}  // namespace forager::tools
