#include "apps/jog/keyboard.hpp"

#include <poll.h>
#include <unistd.h>

namespace takt {
namespace {

constexpr int nothing = -1;

}  // namespace

Keyboard::Keyboard() {
  ::tcgetattr(STDIN_FILENO, &before_);
  termios raw = before_;
  raw.c_lflag &= ~static_cast<tcflag_t>(ICANON | ECHO);
  raw.c_cc[VMIN] = 0;
  raw.c_cc[VTIME] = 0;
  ::tcsetattr(STDIN_FILENO, TCSANOW, &raw);
}

Keyboard::~Keyboard() { ::tcsetattr(STDIN_FILENO, TCSAFLUSH, &before_); }

bool Keyboard::exists() noexcept { return ::isatty(STDIN_FILENO) != 0; }

int Keyboard::byte() {
  pollfd input{.fd = STDIN_FILENO, .events = POLLIN, .revents = 0};
  if (::poll(&input, 1, 0) <= 0) return nothing;
  unsigned char byte = 0;
  if (::read(STDIN_FILENO, &byte, 1) == 1) return byte;
  open_ = false;
  return nothing;
}

/// Returns the next key. The arrow keys are ESC [ C and ESC [ D, or ESC O C and ESC O D.
JogKey Keyboard::next() {
  constexpr int escape = 0x1B;
  const int first = byte();
  if (first == nothing) return JogKey::none;
  if (first == 'l' || first == '+') return JogKey::forward;
  if (first == 'h' || first == '-') return JogKey::backward;
  if (first == 'q') return JogKey::end;
  if (first != escape) return JogKey::other;
  const int second = byte();
  if (second != '[' && second != 'O') return JogKey::other;
  const int third = byte();
  if (third == 'C') return JogKey::forward;
  return third == 'D' ? JogKey::backward : JogKey::other;
}

void Keyboard::forget() { ::tcflush(STDIN_FILENO, TCIFLUSH); }

}  // namespace takt
