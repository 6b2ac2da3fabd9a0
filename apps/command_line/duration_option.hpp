#pragma once
#include <CLI/CLI.hpp>
#include <string>

#include "apps/command_line/duration.hpp"

namespace takt {

/// Adds an option with a duration. `time` is a Time, or an optional one.
template <class Duration>
void add_duration(CLI::App& app, const std::string& name, Duration& time, const std::string& what) {
  app.add_option_function<std::string>(
         name, [&time](const std::string& text) { time = parse_duration(text).value_or(Time{}); },
         what)
      ->check(duration_error);
}

}  // namespace takt
