#include "apps/takt/service/transfer_progress.hpp"

#include <algorithm>
#include <chrono>
#include <cstdio>
#include <fmt/format.h>
#include <string>
#include <unistd.h>

#include "master/linux/clock.hpp"

namespace takt {
namespace {

constexpr Time on_terminal = std::chrono::milliseconds{200};
constexpr Time elsewhere = std::chrono::seconds{2};

double seconds(Time time) { return std::chrono::duration<double>(time).count(); }

std::string rate_text(std::size_t bytes, Time span) {
  const double rate = static_cast<double>(bytes) / std::max(seconds(span), 1e-3);
  return rate < 1e4 ? fmt::format("{:.0f} byte/s", rate) : fmt::format("{:.1f} kB/s", rate / 1e3);
}

}  // namespace

TransferProgress::TransferProgress()
    : began_{monotonic_now()},
      next_{began_ + on_terminal},
      terminal_{::isatty(STDERR_FILENO) == 1} {}

void TransferProgress::show(std::size_t done, std::size_t total) {
  const Time now = monotonic_now();
  if (now < next_) return;
  next_ = now + (terminal_ ? on_terminal : elsewhere);
  std::string text = fmt::format("{} bytes", done);
  if (total != 0) text = fmt::format("{} of {} bytes, {} %", done, total, done * 100 / total);
  text += ", " + rate_text(done, now - began_);
  std::fprintf(stderr, terminal_ ? "\r%-60s" : "%s\n", text.c_str());
  shown_ = true;
}

void TransferProgress::finish(std::size_t bytes) {
  const Time span = monotonic_now() - began_;
  const std::string text =
      fmt::format("{} bytes in {:.1f} s, {}", bytes, seconds(span), rate_text(bytes, span));
  std::fprintf(stderr, "%s%-60s\n", terminal_ && shown_ ? "\r" : "", text.c_str());
}

}  // namespace takt
