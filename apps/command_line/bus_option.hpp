#pragma once
#include <CLI/CLI.hpp>
#include <string>

namespace takt {

/// Refuses an empty name of a bus, because a script may pass a variable that is not set. Returns
/// the reason, or an empty string if `text` is good.
inline std::string empty_bus_error(const std::string& text) {
  if (!text.empty()) return {};
  return "the name of the bus is empty: name a bus, such as can0, or leave --bus out (`interface:` "
         "in a network file names the bus, too)";
}

/// Adds the option `--bus`.
template <class T>
CLI::Option* add_bus(CLI::App& app, T& bus, const std::string& what) {
  return app.add_option("--bus", bus, what)->check(empty_bus_error);
}

}  // namespace takt
