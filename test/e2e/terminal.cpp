#include "test/e2e/terminal.hpp"

#include <chrono>
#include <csignal>
#include <cstdlib>
#include <gtest/gtest.h>
#include <poll.h>
#include <pty.h>
#include <sys/wait.h>
#include <termios.h>
#include <unistd.h>

#include "test/support/time_limit.hpp"

namespace takt::test {
namespace {

using Clock = std::chrono::steady_clock;

}  // namespace

Terminal::Terminal(std::vector<std::string> arguments) {
  std::vector<char*> pointers;
  for (std::string& argument : arguments) pointers.push_back(argument.data());
  pointers.push_back(nullptr);
  const winsize size{.ws_row = 20, .ws_col = 140, .ws_xpixel = 0, .ws_ypixel = 0};
  pid_ = ::forkpty(&fd_, nullptr, nullptr, &size);
  if (pid_ == 0) {
    ::setenv("TERM", "xterm", 1);
    ::execv(pointers[0], pointers.data());
    ::_exit(127);
  }
  EXPECT_GT(pid_, 0);
}

Terminal::~Terminal() {
  if (pid_ > 0) {
    ::kill(pid_, SIGKILL);
    ::waitpid(pid_, nullptr, 0);
  }
  ::close(fd_);
}

void Terminal::press(const std::string& keys) const {
  EXPECT_EQ(::write(fd_, keys.data(), keys.size()), static_cast<ssize_t>(keys.size()));
}

void Terminal::read() {
  pollfd input{.fd = fd_, .events = POLLIN, .revents = 0};
  char bytes[4096];
  if (::poll(&input, 1, 20) <= 0) return;
  const ssize_t count = ::read(fd_, bytes, sizeof bytes);
  if (count > 0) shown_.append(bytes, static_cast<std::size_t>(count));
}

bool Terminal::shows(const std::string& text, const std::function<void()>& meanwhile) {
  const auto until = Clock::now() + time_limit;
  shown_.clear();
  while (shown_.find(text) == std::string::npos) {
    if (Clock::now() > until) {
      ADD_FAILURE() << "the terminal does not show `" << text << "` but\n" << shown_;
      return false;
    }
    read();
    if (meanwhile) meanwhile();
  }
  return true;
}

std::optional<int> Terminal::wait() {
  const auto until = Clock::now() + time_limit;
  int status = 0;
  while (::waitpid(pid_, &status, WNOHANG) == 0) {
    if (Clock::now() > until) return std::nullopt;
    read();
  }
  pid_ = -1;
  if (!WIFEXITED(status)) return std::nullopt;
  return WEXITSTATUS(status);
}

bool Terminal::is_as_before() const {
  termios now{};
  if (::tcgetattr(fd_, &now) != 0) return false;
  return (now.c_lflag & ICANON) != 0 && (now.c_lflag & ECHO) != 0;
}

}  // namespace takt::test
