#include <chrono>
#include <csignal>
#include <cstdio>
#include <expected>
#include <fmt/format.h>
#include <optional>
#include <string>
#include <takt/motion.hpp>
#include <unistd.h>
#include <utility>

#include "apps/axis/lcm_access.hpp"
#include "apps/home/home_options.hpp"
#include "master/lcm/printable_text.hpp"

namespace {

volatile std::sig_atomic_t stop = 0;

void on_signal(int) { stop = 1; }

std::expected<takt::Axes, takt::Obstacle> open_axes(const takt::HomeOptions& options) {
  using takt::Obstacle;
  auto lcm = takt::open_lcm(options.lcm);
  if (!lcm) return std::unexpected{lcm.error()};
  std::optional<takt::EnvelopeKey> key;
  if (!options.lcm.keys.empty()) {
    auto keys = takt::load_keys(options.lcm.keys);
    if (!keys) {
      return std::unexpected{Obstacle{.kind = Obstacle::Kind::wrong_use, .text = keys.error()}};
    }
    key = keys->front();
  }
  takt::AxesOptions wanted{.bus = options.bus,
                           .names = options.axes,
                           .sender = fmt::format("takt-home {}", ::getpid()),
                           .longest = options.wait,
                           .timeout = std::chrono::ceil<std::chrono::milliseconds>(options.timeout),
                           .interrupted = [] { return stop != 0; }};
  return takt::Axes::open(std::move(*lcm), std::move(wanted), key ? &*key : nullptr);
}

void show(const takt::Axes& axes) {
  for (Eigen::Index i = 0; i < axes.size(); ++i) {
    const std::string& unit = axes.unit(i);
    fmt::print("{} {} and stands at {:.4f} {}\n", axes.name(i),
               axes.homed(i) ? "is homed" : "is not homed", axes.positions()(i),
               unit.empty() ? "counts" : unit);
  }
}

/// Homes the axes, and disables them in any case.
takt::Done run(const takt::HomeOptions& options) {
  auto axes = open_axes(options);
  if (!axes) return std::unexpected{axes.error()};
  takt::Done homed = options.reset ? axes->reset() : takt::Done{};
  if (homed) homed = axes->home(options.homing);
  show(*axes);
  const takt::Done disabled = axes->disable();
  return homed ? disabled : homed;
}

int exit_code(takt::Obstacle::Kind kind) {
  if (kind == takt::Obstacle::Kind::wrong_use) return 2;
  return kind == takt::Obstacle::Kind::no_bus ? 3 : 1;
}

}  // namespace

int main(int argc, char** argv) {
  const auto [options, code] = takt::parse_home(argc, argv);
  if (code) return *code;
  for (const int signal : {SIGINT, SIGTERM, SIGHUP, SIGPIPE}) std::signal(signal, on_signal);
  const takt::Done done = run(options);
  if (done) return 0;
  fmt::print(stderr, "takt-home: {}\n", takt::printable_text(done.error().text));
  return exit_code(done.error().kind);
}
