#pragma once
#include <CLI/CLI.hpp>
#include <string>

namespace takt {

/// Empty, or why `text` is no number to CLI11 as it is to people: it reads 010 as 8, as C does.
std::string octal_trouble(const std::string& text);

/// An option that takes a whole number: decimal, or hex with 0x.
template <class T>
CLI::Option* add_number(CLI::App& app, const std::string& name, T& number,
                        const std::string& what) {
  return app.add_option(name, number, what)->check(octal_trouble);
}

}  // namespace takt
