#include "apps/home/home_options.hpp"

#include <CLI/CLI.hpp>

#include "apps/command_line/duration_option.hpp"
#include "apps/command_line/known_words.hpp"
#include "apps/command_line/live_arguments.hpp"

namespace takt {

ParsedHome parse_home(int argc, char** argv) {
  HomeOptions options;
  CLI::App app{"Homes axes: each drive finds its home position by its homing method.", "takt-home"};
  app.footer(
      "Example:  takt-home demo shoulder elbow\n"
      "The method, the speeds and the longest time are those of `homing:` in the network file.\n"
      "Ctrl-C ends the homing; the axes stop, and are disabled.\n"
      "Exit codes: 0 all axes are homed and disabled, 1 an axis was not homed, 2 wrong use,\n"
      "3 no message of a daemon came.");
  app.set_version_flag("--version", "takt-home " TAKT_VERSION);
  app.add_option("bus", options.program.bus, "name of the bus")->required();
  app.add_option("axes", options.program.axes,
                 "names of the axes, in the order of their homing (default: all axes of the bus)");
  app.add_flag_callback(
      "--together", [&] { options.homing.order = HomingOptions::Order::together; },
      "home all axes at once, not one after the other");
  app.add_flag("--reset", options.reset, "reset the faults of the axes first");
  add_duration(
      app, "--within", options.homing.longest,
      "longest time of a homing run (default: the time in the network file, otherwise 60s)");
  add_duration(app, "--timeout", options.program.timeout,
               "longest silence of this program, up to 10s; after it the drives take their "
               "fallback (500ms)");
  add_duration(app, "--wait", options.program.wait,
               "longest wait for the daemon and the drives (10s)");
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
