#include "apps/axis/axes_program.hpp"

#include <csignal>
#include <fmt/format.h>
#include <optional>
#include <unistd.h>
#include <utility>

#include "master/lcm/printable_text.hpp"

namespace takt {
namespace {

volatile std::sig_atomic_t stop = 0;

void on_signal(int) { stop = 1; }

std::unexpected<Obstacle> wrong_use(std::string text) {
  return std::unexpected{Obstacle{.kind = Obstacle::Kind::wrong_use, .text = std::move(text)}};
}

}  // namespace

std::expected<Axes, Obstacle> open_axes(const AxesProgram& program) {
  auto lcm = open_lcm(program.lcm);
  if (!lcm) return std::unexpected{lcm.error()};
  std::optional<EnvelopeKey> key;
  if (!program.lcm.keys.empty()) {
    auto keys = load_keys(program.lcm.keys);
    if (!keys) return wrong_use(keys.error());
    key = keys->front();
  }
  return Axes::open(program.through ? program.through(std::move(*lcm)) : std::move(*lcm),
                    {.bus = program.bus,
                     .names = program.axes,
                     .sender = fmt::format("{} {}", program.name, ::getpid()),
                     .longest = program.wait,
                     .timeout = std::chrono::ceil<std::chrono::milliseconds>(program.timeout),
                     .interrupted = [] { return stop != 0; }},
                    key ? &*key : nullptr);
}

std::expected<Axes, Obstacle> open_axis(const AxesProgram& program) {
  auto axes = open_axes(program);
  if (!axes || axes->size() == 1) return axes;
  std::string names;
  for (Eigen::Index i = 0; i < axes->size(); ++i) names += (i == 0 ? "" : ", ") + axes->name(i);
  return wrong_use("give --axis NAME; the bus has " + names);
}

int run_program(const std::string& name, const std::function<Done()>& work) {
  for (const int signal : {SIGINT, SIGTERM, SIGHUP, SIGPIPE}) std::signal(signal, on_signal);
  const Done done = work();
  if (done) return 0;
  fmt::print(stderr, "{}: {}\n", name, printable_text(done.error().text));
  if (done.error().kind == Obstacle::Kind::wrong_use) return 2;
  return done.error().kind == Obstacle::Kind::no_bus ? 3 : 1;
}

}  // namespace takt
