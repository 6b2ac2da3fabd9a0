#include "apps/command_line/interrupt.hpp"

#include <csignal>

namespace takt {
namespace {

volatile std::sig_atomic_t asked_for = 0;

void on_signal(int number) {
  asked_for = 1;
  std::signal(number, SIG_DFL);
}

}  // namespace

Interrupt::Interrupt() {
  asked_for = 0;
  std::signal(SIGINT, on_signal);
  std::signal(SIGTERM, on_signal);
}

Interrupt::~Interrupt() {
  std::signal(SIGINT, SIG_DFL);
  std::signal(SIGTERM, SIG_DFL);
}

bool Interrupt::asked() noexcept { return asked_for != 0; }

}  // namespace takt
