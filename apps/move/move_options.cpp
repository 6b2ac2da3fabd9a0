#include "apps/move/move_options.hpp"

#include <CLI/CLI.hpp>
#include <cmath>
#include <map>

#include "apps/command_line/known_words.hpp"
#include "apps/command_line/live_arguments.hpp"

namespace takt {
namespace {

/// Refuses a number that is not finite, because the checks of CLI11 accept "nan".
std::string finite(const std::string& text) {
  double value = 0.0;
  const bool good = CLI::detail::lexical_cast(text, value) && std::isfinite(value);
  return good ? std::string{} : text + " is not a finite number";
}

CLI::Validator positive() { return CLI::PositiveNumber & CLI::Validator{finite, ""}; }

void add_motion_options(CLI::App& app, MoveOptions& options) {
  app.add_option("--amplitude", options.amplitude,
                 "amplitude of the sine, in the unit of each axis")
      ->check(positive());
  app.add_option("--frequency", options.frequency, "frequency of the sine, Hz")->check(positive());
  app.add_option("--velocity", options.velocity, "velocity limit, unit/s")->check(positive());
  app.add_option("--acceleration", options.acceleration, "acceleration limit, unit/s^2")
      ->check(positive());
  app.add_option("--jerk", options.jerk, "jerk limit, unit/s^3")->check(positive());
  app.add_option("--following-limit", options.following_limit,
                 "largest following error for exit code 0")
      ->check(positive());
  app.add_option("--stale", options.stale_cycles,
                 "hold the motion while the newest image is older than this, cycles")
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
      "Lengths are in the unit of each axis (rad, m; counts if no unit is configured).\n"
      "Exit codes: 0 the axes followed, 1 the axes did not follow or did not reach the end,\n"
      "or another program holds them, 2 wrong use or no axis to move, 3 no message of a daemon "
      "came.");
  app.set_version_flag("--version", "takt-move " TAKT_VERSION);
  app.add_option("bus", options.bus, "name of the bus (default: the first bus whose daemon sends)");
  app.add_option("--lcm-url", options.lcm_url, "LCM URL of the daemon; default: LCM_DEFAULT_URL");
  add_key_options(app, options.keys, options.check_images);
  auto* const to = app.add_option("--to", options.to, "target of each axis, or one for all");
  to->delimiter(',')->check(finite);
  app.add_flag("--sine", only_sine, "move in a sine (without --to: only in a sine)");
  app.add_option("--for", options.seconds,
                 "longest duration of the whole motion; the sine fills it\n"
                 "(default: 10 s, or what the motion needs)")
      ->transform(CLI::AsNumberWithUnit(
          std::map<std::string, double>{{"s", 1.0}, {"ms", 1e-3}, {"min", 60.0}},
          CLI::AsNumberWithUnit::CASE_INSENSITIVE, "TIME"))
      ->check(positive());
  app.add_option("--wait", options.wait_seconds, "longest wait for the daemon and its devices, s")
      ->check(positive());
  add_motion_options(app, options);
  app.add_option("--plot", options.plot,
                 "write a picture of the motions, commanded and actual, as an SVG file")
      ->type_name("FILE.svg");
  if (const auto exit_code = parse_arguments(app, argc, argv)) return {options, exit_code};
  if (to->count() != 0 || only_sine) {
    options.point = to->count() != 0;
    options.sine = only_sine;
  }
  return {options, std::nullopt};
}

}  // namespace takt
