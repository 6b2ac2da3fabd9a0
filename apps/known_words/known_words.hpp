#pragma once
#include <CLI/CLI.hpp>
#include <string>
#include <vector>

namespace takt {

/// What is wrong with the names of commands and options on a command line, with the name that is
/// most likely meant; empty: all are known. CLI11 itself would tell what is missing instead.
std::string unknown_word(const CLI::App& app, int argc, const char* const* argv);

/// `, did you mean 'start'?`, or nothing.
std::string guess(const std::string& word, const std::vector<std::string>& names);

/// The value of an option that is one of these words; another one is told with a guess.
CLI::Validator one_of(std::vector<std::string> words);

}  // namespace takt
