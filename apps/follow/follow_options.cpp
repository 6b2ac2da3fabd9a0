#include "apps/follow/follow_options.hpp"

#include <CLI/CLI.hpp>
#include <charconv>
#include <cmath>
#include <string_view>

#include "apps/command_line/duration_option.hpp"
#include "apps/command_line/known_words.hpp"
#include "apps/command_line/live_arguments.hpp"

namespace takt {
namespace {

std::optional<double> number(std::string_view text) {
  double value = 0.0;
  const auto read = std::from_chars(text.data(), text.data() + text.size(), value);
  const bool good = read.ec == std::errc{} && read.ptr == text.data() + text.size();
  return good && std::isfinite(value) ? std::optional{value} : std::nullopt;
}

/// Reads "1.5", "-1/3" or "2:1".
std::optional<double> ratio_of(std::string_view text) {
  const std::size_t split = text.find_first_of("/:");
  if (split == std::string_view::npos) return number(text);
  const auto above = number(text.substr(0, split));
  const auto below = number(text.substr(split + 1));
  if (!above || !below || *below == 0.0) return std::nullopt;
  return *above / *below;
}

std::string no_ratio(const std::string& text) {
  return ratio_of(text) ? std::string{}
                        : text + " is neither a finite number nor a finite ratio such as 1/3";
}

std::string not_finite(const std::string& text) {
  return number(text) ? std::string{} : text + " is not a finite number";
}

void add_limit(CLI::App& app, const std::string& name, double& limit, const std::string& what) {
  app.add_option(name, limit, what)->check(CLI::PositiveNumber & CLI::Validator{not_finite, ""});
}

}  // namespace

ParsedFollow parse_follow(int argc, char** argv) {
  FollowOptions options;
  CLI::App app{"Lets an axis follow an encoder or another axis. taktd computes the motion.",
               "takt-follow"};
  app.footer(
      "Ctrl-C stops the axis and disables it.\n"
      "Example:  takt-follow follow --axis slide --leader wheel --signal position_value \\\n"
      "              --ratio 1/4096 --velocity 5 --acceleration 40\n"
      "Lengths are in the unit of the axis (rad, m; counts if no unit is configured).\n"
      "Exit codes: 0 the axis was stopped and disabled, 1 something blocks the axis, 2 wrong use,\n"
      "3 no message of a daemon came.");
  app.set_version_flag("--version", "takt-follow " TAKT_VERSION);
  app.add_option("bus", options.program.bus,
                 "name of the bus (default: the first bus whose daemon sends)");
  app.add_option_function<std::string>(
      "--axis", [&](const std::string& name) { options.program.axes = {name}; },
      "axis that follows (default: the only axis of the bus)");
  app.add_option("--leader", options.leader,
                 "axis to follow, or the node whose input --signal names")
      ->required();
  app.add_option("--signal", options.signal,
                 "input of the leader to follow, for example position_value (default: the "
                 "commanded position of the leader)");
  app.add_option_function<std::string>(
         "--ratio",
         [&](const std::string& text) { options.ratio = ratio_of(text).value_or(options.ratio); },
         "units of the axis per unit of the leader, for example 0.5 or -1/3 (1)")
      ->check(no_ratio);
  app.add_option(
         "--phase", options.phase,
         "reach and keep the position ratio * leader + PHASE (default: match only the velocities)")
      ->check(not_finite);
  add_limit(app, "--modulo", options.modulo,
            "value at which the signal wraps around, for example the counts of one turn");
  add_duration(app, "--filter", options.filter_time,
               "time constant of the estimate of the signal's velocity, up to 10s (20ms)");
  add_limit(app, "--max-phase-error", options.max_phase_error,
            "largest phase error; above it the axis stops (default: the axis falls behind and "
            "catches up)");
  add_limit(app, "--velocity", options.velocity,
            "velocity limit, unit/s (default: the limit of the network file)");
  add_limit(app, "--acceleration", options.acceleration,
            "acceleration limit, unit/s^2 (default: the limit of the network file)");
  add_limit(app, "--jerk", options.jerk,
            "jerk limit, unit/s^3 (default: the limit of the network file)");
  add_duration(app, "--timeout", options.program.timeout,
               "longest silence of this program, up to 10s; after it taktd stops the axis (500ms)");
  add_duration(
      app, "--for", options.seconds,
      "follow for this time, which counts while the axis is locked to its leader, then stop");
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
