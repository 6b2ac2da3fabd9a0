#pragma once
#include <CLI/CLI.hpp>
#include <optional>
#include <string>
#include <vector>

namespace takt {

/// Returns a message on the first unknown command or option of a command line, with the name that
/// is most likely meant. The message is empty if all names are known. CLI11 itself would report
/// what is missing instead.
std::string unknown_word(const CLI::App& app, int argc, const char* const* argv);

/// Parses the command line of a program. Returns the exit code if the program ends with it, because
/// the command line is wrong or asks for help.
std::optional<int> parse_arguments(CLI::App& app, int argc, const char* const* argv);

/// Returns `, did you mean 'start'?`, or an empty text if no name is similar to the word.
std::string guess(const std::string& word, const std::vector<std::string>& names);

/// Returns a check that accepts only these words as the value of an option. For another word, the
/// message suggests a similar one.
CLI::Validator one_of(std::vector<std::string> words);

}  // namespace takt
