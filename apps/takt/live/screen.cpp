#include "apps/takt/live/screen.hpp"

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <poll.h>
#include <sys/ioctl.h>
#include <termios.h>
#include <unistd.h>

#include "eds_parser/table/name_of.hpp"
#include "master/lcm/printable_text.hpp"

namespace takt {
namespace {

bool begins_character(char c) noexcept { return (static_cast<unsigned char>(c) & 0xC0) != 0x80; }

std::string_view escape(Paint paint) noexcept {
  static constexpr std::string_view sequences[]{"",         "\033[1m",  "\033[2m",
                                                "\033[32m", "\033[33m", "\033[1;31m"};
  return name_of(paint, sequences);
}

/// Returns the first `width` characters of `text` and subtracts their number from `width`.
std::string_view cut(std::string_view text, std::size_t& width) noexcept {
  std::size_t at = 0;
  while (at < text.size()) {
    if (begins_character(text[at])) {
      if (width == 0) break;
      --width;
    }
    ++at;
  }
  return text.substr(0, at);
}

std::size_t columns_of(std::string_view text) noexcept {
  return static_cast<std::size_t>(std::ranges::count_if(text, begins_character));
}

termios saved_terminal{};

void put_back() {
  ::tcsetattr(STDIN_FILENO, TCSANOW, &saved_terminal);
  std::fputs("\033[?25h\033[?1049l", stdout);
  std::fflush(stdout);
}

}  // namespace

Line& Line::add(std::string_view text, Paint paint) {
  pieces_.push_back({printable_text(text), paint});
  return *this;
}

std::string Line::render(std::size_t width, bool colour) const {
  std::string text;
  for (const Piece& piece : pieces_) {
    const std::string_view shown = cut(piece.text, width);
    const bool painted = colour && piece.paint != Paint::plain;
    if (painted) text += escape(piece.paint);
    text += shown;
    if (painted) text += "\033[0m";
  }
  return text;
}

void print_lines(const std::vector<Line>& lines, std::size_t width) {
  const bool terminal = ::isatty(STDOUT_FILENO) != 0;
  if (terminal) width = Screen::size().columns;
  for (const Line& line : lines) std::puts(line.render(width, terminal).c_str());
}

std::string left(std::string_view text, std::size_t width) {
  std::size_t room = width;
  std::string padded{cut(text, room)};
  return padded.append(room, ' ');
}

std::string right(std::string_view text, std::size_t width) {
  const std::size_t columns = columns_of(text);
  if (columns >= width) return left(text, width);
  return std::string(width - columns, ' ') + std::string{text};
}

std::string bar(double share, std::size_t width) {
  const double bounded = std::isfinite(share) ? std::clamp(share, 0.0, 1.0) : 0.0;
  const auto full = static_cast<std::size_t>(std::lround(bounded * static_cast<double>(width)));
  std::string text;
  for (std::size_t i = 0; i < width; ++i) text += i < full ? "\u2588" : "\u2591";
  return text;
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
  std::string text = "\033[H";
  for (std::size_t row = 0; row < terminal.rows; ++row) {
    if (row < lines.size()) text += lines[row].render(terminal.columns, true);
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
  return static_cast<unsigned char>(bytes[2]) | 0x80;
}

}  // namespace takt
