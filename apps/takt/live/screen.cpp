#include "apps/takt/live/screen.hpp"

#include <algorithm>
#include <cstdio>
#include <cstdlib>
#include <poll.h>
#include <string>
#include <string_view>
#include <sys/ioctl.h>
#include <termios.h>
#include <unistd.h>

#include "eds_parser/values/number_in.hpp"

namespace takt {
namespace {

constexpr std::size_t usual_width = 80;
constexpr std::size_t least_columns = 20;
constexpr std::size_t most_columns = 1000;

std::string_view environment(const char* name) {
  const char* const value = std::getenv(name);
  return value == nullptr ? std::string_view{} : std::string_view{value};
}

/// https://no-color.org
bool shows_colours() { return moves_cursor() && environment("NO_COLOR").empty(); }

termios saved_terminal{};

void put_back() {
  ::tcsetattr(STDIN_FILENO, TCSANOW, &saved_terminal);
  std::fputs("\033[?25h\033[?1049l", stdout);
  std::fflush(stdout);
}

}  // namespace

std::size_t output_width() {
  if (::isatty(STDOUT_FILENO) != 0) return Screen::size().columns;
  const auto columns = number_in<std::size_t>(environment("COLUMNS"));
  return std::clamp(columns.value_or(usual_width), least_columns, most_columns);
}

bool moves_cursor() {
  const std::string_view terminal = environment("TERM");
  return ::isatty(STDOUT_FILENO) != 0 && !terminal.empty() && terminal != "dumb";
}

void print_lines(const std::vector<Line>& lines, std::size_t width) {
  if (::isatty(STDOUT_FILENO) != 0) width = Screen::size().columns;
  const bool colours = shows_colours();
  for (const Line& line : lines) std::puts(line.render(width, colours).c_str());
}

Screen::Screen() {
  ::tcgetattr(STDIN_FILENO, &saved_terminal);
  termios raw = saved_terminal;
  raw.c_lflag &= ~static_cast<tcflag_t>(ICANON | ECHO);
  raw.c_cc[VMIN] = 0;
  raw.c_cc[VTIME] = 0;
  ::tcsetattr(STDIN_FILENO, TCSANOW, &raw);
  std::fputs("\033[?1049h\033[?25l", stdout);
}

Screen::~Screen() { put_back(); }

Screen::Size Screen::size() {
  winsize window{};
  if (::ioctl(STDOUT_FILENO, TIOCGWINSZ, &window) != 0 || window.ws_col == 0) return {};
  return {.columns = window.ws_col, .rows = window.ws_row};
}

void Screen::show(const std::vector<Line>& lines) const {
  const Size terminal = size();
  const bool colours = shows_colours();
  std::string text = "\033[H";
  for (std::size_t row = 0; row < terminal.rows; ++row) {
    if (row < lines.size()) text += lines[row].render(terminal.columns, colours);
    text += "\033[K";
    if (row + 1 < terminal.rows) text += "\r\n";
  }
  std::fputs(text.c_str(), stdout);
  std::fflush(stdout);
}

int Screen::key() {
  pollfd input{.fd = STDIN_FILENO, .events = POLLIN, .revents = 0};
  char bytes[3] = {};
  if (::poll(&input, 1, 0) <= 0 || ::read(STDIN_FILENO, bytes, 1) != 1) return 0;
  if (bytes[0] != '\033') return static_cast<unsigned char>(bytes[0]);
  if (::read(STDIN_FILENO, bytes + 1, 2) != 2 || bytes[1] != '[') return 0;
  const bool numbered = bytes[2] >= '0' && bytes[2] <= '9';
  char end = '~';
  while (numbered && ::read(STDIN_FILENO, &end, 1) == 1 && end != '~') {
  }
  return static_cast<unsigned char>(bytes[2]) | 0x80;
}

}  // namespace takt
