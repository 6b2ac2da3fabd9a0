#pragma once
#include <CLI/CLI.hpp>
#include <filesystem>
#include <string>

namespace takt {

/// Returns the manual page of a program, or of one command of it, in roff. `path` has the words
/// before it: "takt plan". The page has everything that --help prints.
std::string manual_page(const CLI::App& app, const std::string& path);

/// Writes the manual page of a program, and one for each of its commands, into a folder: takt.1,
/// takt-plan.1 ... Returns false if a file can't be written.
bool write_manual(const CLI::App& app, const std::filesystem::path& folder);

}  // namespace takt
