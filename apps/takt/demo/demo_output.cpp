#include "apps/takt/demo/demo_output.hpp"

#include <cstdio>
#include <cstdlib>
#include <fmt/format.h>
#include <unistd.h>

namespace takt {
namespace {

// With this sequence the terminal cuts a line that is too long, so that the line can be replaced.
constexpr const char* no_wrap = "\x1b[?7l";
constexpr const char* wrap = "\x1b[?7h";

bool moves_its_cursor() {
  const char* const kind = std::getenv("TERM");
  return ::isatty(STDOUT_FILENO) != 0 && kind != nullptr && std::string_view{kind} != "dumb";
}

std::string named(std::string_view program, std::string_view text) {
  return fmt::format("  {:<9} | {}", program, text);
}

}  // namespace

DemoOutput::DemoOutput() : terminal_{moves_its_cursor()} {}

void DemoOutput::say(std::string_view text) { print(fmt::format("{}\n", text)); }

void DemoOutput::line(std::string_view program, std::string_view text) {
  print(named(program, text) + '\n');
}

void DemoOutput::positions(std::string_view program, std::string_view text) {
  if (terminal_) {
    print(no_wrap + named(program, text) + wrap);
    replaceable_ = true;
    return;
  }
  const auto now = std::chrono::steady_clock::now();
  if (now < next_) return;
  next_ = now + std::chrono::seconds{1};
  line(program, text);
}

void DemoOutput::print(std::string_view text) {
  if (replaceable_) std::fputs("\r\x1b[K", stdout);
  replaceable_ = false;
  std::fwrite(text.data(), 1, text.size(), stdout);
  std::fflush(stdout);
}

}  // namespace takt
