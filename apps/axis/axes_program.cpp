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

struct Connection {
  std::unique_ptr<Transport> lcm;
  std::optional<EnvelopeKey> key;
};

std::expected<Connection, Obstacle> connect(const AxesProgram& program) {
  auto lcm = open_lcm(program.lcm);
  if (!lcm) return std::unexpected{lcm.error()};
  Connection made{.lcm = std::move(*lcm), .key = {}};
  if (program.lcm.keys.empty()) return made;
  auto keys = load_keys(program.lcm.keys);
  if (!keys) return wrong_use(keys.error());
  made.key = keys->front();
  return made;
}

std::string sender_of(const AxesProgram& program) {
  return fmt::format("{} {}", program.name, ::getpid());
}

}  // namespace

bool program_interrupted() noexcept { return stop != 0; }

std::expected<Axes, Obstacle> open_axes(const AxesProgram& program) {
  auto connection = connect(program);
  if (!connection) return std::unexpected{connection.error()};
  auto& [lcm, key] = *connection;
  return Axes::open(program.through ? program.through(std::move(lcm)) : std::move(lcm),
                    {.bus = program.bus,
                     .names = program.axes,
                     .sender = sender_of(program),
                     .longest = program.wait,
                     .timeout = std::chrono::ceil<std::chrono::milliseconds>(program.timeout),
                     .interrupted = program_interrupted},
                    key ? &*key : nullptr);
}

std::expected<std::unique_ptr<AxisGroup>, Obstacle> open_group(const AxesProgram& program) {
  auto connection = connect(program);
  if (!connection) return std::unexpected{connection.error()};
  auto group = std::make_unique<AxisGroup>(
      std::move(connection->lcm),
      AxisGroupOptions{.bus = program.bus, .sender = sender_of(program)});
  if (connection->key) group->sign_with(*connection->key);
  return group;
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
