#pragma once
#include <CLI/CLI.hpp>
#include <span>
#include <string>

namespace takt {

/// Returns what can be typed for the last of `words`, which follow the name of the program: one
/// proposal on each line, followed by a tab and its meaning. The last word may be empty or
/// incomplete.
///
/// A line that begins with ':' asks the shell for more: `:files yaml yml` for files (with these
/// extensions, if there are any) and folders, `:directories`, or `:ask KIND ...` for what
/// `takt complete KIND ...` prints.
std::string completions(const CLI::App& app, std::span<const std::string> words);

}  // namespace takt
