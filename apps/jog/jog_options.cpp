#include "apps/jog/jog_options.hpp"

#include <CLI/CLI.hpp>
#include <cmath>

#include "apps/command_line/duration_option.hpp"
#include "apps/command_line/known_words.hpp"
#include "apps/command_line/live_arguments.hpp"

namespace takt {
namespace {

/// Refuses a number that is 0 or not finite.
std::string moving(const std::string& text) {
  double value = 0.0;
  const bool good = CLI::detail::lexical_cast(text, value) && std::isfinite(value) && value != 0.0;
  return good ? std::string{} : text + " is not a finite number other than 0";
}

}  // namespace

ParsedJog parse_jog(int argc, char** argv) {
  JogOptions options;
  CLI::App app{"Moves one axis for as long as a key is held. taktd runs the motion.", "takt-jog"};
  app.footer(
      "Keys: right arrow, l or + moves the axis forward; left arrow, h or - moves it backward.\n"
      "Every other key stops the axis. q and Ctrl-C stop the axis and end the program.\n"
      "Example:  takt-jog demo --axis shoulder --velocity 0.5\n"
      "Lengths are in the unit of the axis (rad, m; counts if no unit is configured), velocities "
      "in\n"
      "this unit per second. An inverter has speeds in its unit (rpm, Hz) and no lengths.\n"
      "Exit codes: 0 the axis was stopped and disabled, 1 something blocks the axis, 2 wrong use,\n"
      "3 no message of a daemon came.");
  app.set_version_flag("--version", "takt-jog " TAKT_VERSION);
  app.add_option("bus", options.program.bus,
                 "name of the bus (default: the first bus whose daemon sends)");
  app.add_option_function<std::string>(
      "--axis", [&](const std::string& name) { options.program.axes = {name}; },
      "name of the axis (default: the only axis of the bus)");
  app.add_option("--velocity", options.velocity,
                 "velocity of the jog, unit/s; a negative one swaps the directions of the keys")
      ->required()
      ->check(moving);
  app.add_option(
         "--acceleration", options.acceleration,
         "acceleration limit, unit/s^2 (default: the velocity is reached in 0.25 s; an inverter "
         "follows its own ramp)")
      ->check(CLI::PositiveNumber & CLI::Validator{moving, ""});
  app.add_option("--jerk", options.jerk,
                 "jerk limit, unit/s^3 (default: the limit of the network file)")
      ->check(CLI::PositiveNumber & CLI::Validator{moving, ""});
  add_duration(app, "--dead-man", options.dead_man,
               "longest time between two repetitions of the key; after it the axis stops (250ms)");
  add_duration(app, "--first", options.first,
               "longest time from the press of the key to its first repetition; after it the axis "
               "stops (700ms)");
  add_duration(app, "--timeout", options.program.timeout,
               "longest silence of this program, up to 10s; after it taktd stops the axis (500ms)");
  add_duration(app, "--for", options.seconds, "jog for this time without a keyboard, then stop");
  add_duration(app, "--wait", options.program.wait,
               "longest wait for the daemon and the drive (10s)");
  app.add_option("--plot", options.program.plot,
                 "write a picture of the motions, commanded and actual, as an SVG file")
      ->type_name("FILE.svg");
  app.add_option("--lcm-url", options.program.lcm.url,
                 "LCM URL of the daemon; default: LCM_DEFAULT_URL");
  add_key_options(app, options.program.lcm.keys, options.program.lcm.check_images);
  const auto exit_code = parse_arguments(app, argc, argv);
  return {options, exit_code};
}

}  // namespace takt
