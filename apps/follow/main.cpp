#include <chrono>
#include <csignal>
#include <expected>
#include <fmt/format.h>
#include <optional>
#include <string>
#include <takt/motion.hpp>
#include <unistd.h>
#include <utility>

#include "apps/axis/lcm_access.hpp"
#include "apps/follow/follow_options.hpp"
#include "apps/follow/follow_run.hpp"
#include "master/lcm/printable_text.hpp"

namespace {

volatile std::sig_atomic_t stop = 0;

void on_signal(int) { stop = 1; }

takt::Done run(const takt::FollowOptions& options) {
  using takt::Obstacle;
  auto lcm = takt::open_lcm(options.lcm);
  if (!lcm) return std::unexpected{lcm.error()};
  takt::AxesOptions wanted{.bus = options.bus,
                           .sender = fmt::format("takt-follow {}", ::getpid()),
                           .longest = options.wait,
                           .timeout = std::chrono::ceil<std::chrono::milliseconds>(options.timeout),
                           .interrupted = [] { return stop != 0; }};
  if (!options.axis.empty()) wanted.names = {options.axis};
  std::optional<takt::EnvelopeKey> key;
  if (!options.lcm.keys.empty()) {
    auto keys = takt::load_keys(options.lcm.keys);
    if (!keys) {
      return std::unexpected{Obstacle{.kind = Obstacle::Kind::wrong_use, .text = keys.error()}};
    }
    key = keys->front();
  }
  auto axes = takt::Axes::open(std::move(*lcm), std::move(wanted), key ? &*key : nullptr);
  if (!axes) return std::unexpected{axes.error()};
  if (axes->size() != 1) {
    std::string names;
    for (Eigen::Index i = 0; i < axes->size(); ++i) names += (i == 0 ? "" : ", ") + axes->name(i);
    return std::unexpected{Obstacle{.kind = Obstacle::Kind::wrong_use,
                                    .text = "give --axis NAME; the bus has " + names}};
  }
  return takt::FollowRun{*axes, options}.run();
}

int exit_code(takt::Obstacle::Kind kind) {
  if (kind == takt::Obstacle::Kind::wrong_use) return 2;
  return kind == takt::Obstacle::Kind::no_bus ? 3 : 1;
}

}  // namespace

int main(int argc, char** argv) {
  const auto [options, code] = takt::parse_follow(argc, argv);
  if (code) return *code;
  for (const int signal : {SIGINT, SIGTERM, SIGHUP, SIGPIPE}) std::signal(signal, on_signal);
  const takt::Done done = run(options);
  if (done) return 0;
  fmt::print(stderr, "takt-follow: {}\n", takt::printable_text(done.error().text));
  return exit_code(done.error().kind);
}
