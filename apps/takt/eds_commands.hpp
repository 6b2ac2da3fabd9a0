#pragma once
#include <CLI/CLI.hpp>

namespace takt {

/// Verbs of `takt eds` with a file of their own.
void add_eds_dcf(CLI::App& eds, int& exit_code);
void add_eds_cdcf(CLI::App& eds, int& exit_code);
void add_eds_fix(CLI::App& eds, int& exit_code);

}  // namespace takt
