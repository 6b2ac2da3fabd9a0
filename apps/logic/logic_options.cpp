#include "apps/logic/logic_options.hpp"

#include <CLI/CLI.hpp>

#include "apps/command_line/duration_option.hpp"
#include "apps/command_line/known_words.hpp"
#include "apps/command_line/live_arguments.hpp"

namespace takt {

ParsedLogic parse_logic(int argc, char** argv) {
  LogicOptions options;
  CLI::App app{"Sets outputs of I/O nodes by rules over inputs, once for each image of the bus.",
               "takt-logic"};
  app.footer(
      "Example:  takt-logic share/demo/logic/rules.yaml demo\n"
      "A rule of the file:  - {set: io.lamp, when: io.button and not shoulder.fault, off_delay: "
      "1s}\n"
      "Ctrl-C ends the program; the outputs take the fallback of `on_timeout`.\n"
      "Exit codes: 0 ended by a signal or --for, 1 something blocks the program, 2 wrong use or a\n"
      "wrong file, 3 no message of a daemon came.");
  app.set_version_flag("--version", "takt-logic " TAKT_VERSION);
  app.add_option("rules", options.file, "file with the rules")->required()->type_name("FILE");
  app.add_option("bus", options.program.bus,
                 "name of the bus (default: the first bus whose daemon sends)");
  app.add_flag("--check", options.check, "print the rules and end; this needs no bus");
  app.add_flag("--quiet", options.quiet, "do not print the changes of outputs and markers");
  app.add_option("--plot", options.program.plot,
                 "write a picture of all inputs and outputs of the rules, as an SVG file")
      ->type_name("FILE.svg");
  add_duration(app, "--for", options.seconds, "end after this time");
  add_duration(app, "--wait", options.program.wait, "longest wait for the daemon (10s)");
  app.add_option("--lcm-url", options.program.lcm.url,
                 "LCM URL of the daemon; default: LCM_DEFAULT_URL");
  add_key_options(app, options.program.lcm.keys, options.program.lcm.check_images);
  const auto exit_code = parse_arguments(app, argc, argv);
  return {options, exit_code};
}

}  // namespace takt
