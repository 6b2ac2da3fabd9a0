#pragma once
#include <CLI/CLI.hpp>
#include <string>

namespace takt {

/// Refuses decimal numbers with a leading zero, because CLI11 reads 010 as octal 8, as C does.
/// Returns the reason, or an empty string if `text` is good.
std::string octal_error(const std::string& text);

/// Adds an option that takes a whole number, decimal or hex with 0x.
template <class T>
CLI::Option* add_number(CLI::App& app, const std::string& name, T& number,
                        const std::string& what) {
  return app.add_option(name, number, what)->check(octal_error);
}

/// Adds the option `--node` of the commands that read an EDS.
inline void add_node_id(CLI::App& app, unsigned& node, const std::string& what) {
  add_number(app, "--node", node, what)->check(CLI::Range(1U, 127U));
}

}  // namespace takt
