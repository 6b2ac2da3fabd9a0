#include "apps/move/options.hpp"

#include <CLI/CLI.hpp>

namespace takt {
namespace {

/// A distance that looks like a motion and fits most machines.
double default_distance(const std::string& unit) {
  if (unit == "rad") return 1.5;
  if (unit == "deg" || unit == "°") return 90.0;
  if (unit == "m") return 0.1;
  if (unit == "mm") return 100.0;
  return 10000.0;  // raw counts
}

void add_motion_options(CLI::App& app, MoveOptions& options) {
  const auto positive = CLI::PositiveNumber;
  app.add_option("--amplitude", options.amplitude, "of the sine")->check(positive);
  app.add_option("--frequency", options.frequency, "of the sine, Hz")->check(positive);
  app.add_option("--velocity", options.velocity, "limit, unit/s")->check(positive);
  app.add_option("--acceleration", options.acceleration, "limit, unit/s^2")->check(positive);
  app.add_option("--jerk", options.jerk, "limit, unit/s^3")->check(positive);
  app.add_option("--following-limit", options.following_limit,
                 "largest following error for exit code 0")
      ->check(positive);
  app.add_option("--stale", options.stale_cycles, "hold when the image is older, cycles")
      ->check(CLI::Range(1, 100000));
}

}  // namespace

ParsedMove parse_move(int argc, char** argv) {
  MoveOptions options;
  bool only_sine = false;
  CLI::App app{"Moves all axes of a bus: together to a point, jerk-limited, then in a sine.",
               "takt-move"};
  app.footer(
      "Example:  takt-move lift --to 1.57,0.5 --sine --for 20s\n"
      "Lengths are in the axes' unit (rad, m; counts where none is configured).\n"
      "Exit codes: 0 the axes followed, 1 they did not, or not to the end, 2 wrong use, 3 no "
      "daemon heard.");
  app.set_version_flag("--version", "takt-move " TAKT_VERSION);
  app.add_option("bus", options.bus, "name of the bus (default: the first that is heard)");
  app.add_option("--lcm-url", options.lcm_url, "as LCM_DEFAULT_URL");
  auto* const to = app.add_option("--to", options.to, "target of each axis, or one for all");
  to->delimiter(',');
  app.add_flag("--sine", only_sine, "a sine (without --to: only a sine)");
  app.add_option("--for", options.seconds, "time of all motion")
      ->transform(CLI::AsNumberWithUnit(
          std::map<std::string, double>{{"s", 1.0}, {"ms", 1e-3}, {"min", 60.0}},
          CLI::AsNumberWithUnit::CASE_INSENSITIVE, "TIME"))
      ->check(CLI::PositiveNumber);
  app.add_option("--wait", options.wait_seconds, "for the daemon and its devices, s")
      ->check(CLI::PositiveNumber);
  add_motion_options(app, options);
  try {
    app.parse(argc, argv);
  } catch (const CLI::ParseError& error) {
    return {options, app.exit(error) == 0 ? 0 : 2};
  }
  if (to->count() != 0 || only_sine) {
    options.point = to->count() != 0;
    options.sine = only_sine;
  }
  return {options, std::nullopt};
}

MoveSizes sizes_for(const MoveOptions& options, const std::string& unit) {
  const double distance = default_distance(unit);
  return {.distance = distance,
          .amplitude = options.amplitude.value_or(distance / 4.0),
          .following_limit = options.following_limit.value_or(distance / 30.0),
          .limits = {.velocity = options.velocity.value_or(distance * 0.8),
                     .acceleration = options.acceleration.value_or(distance * 2.0),
                     .jerk = options.jerk.value_or(distance * 10.0)}};
}

}  // namespace takt
