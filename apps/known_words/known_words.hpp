#pragma once
#include <CLI/CLI.hpp>
#include <string>

namespace takt {

/// What is wrong with the names of commands and options on a command line, with the name that is
/// most likely meant; empty: all are known. CLI11 itself would tell what is missing instead.
std::string unknown_word(const CLI::App& app, int argc, const char* const* argv);

}  // namespace takt
