#pragma once

namespace CLI {
class App;
}

namespace takt {

/// The verbs of `takt eds` that have separate source files.
void add_eds_dcf(CLI::App& eds, int& exit_code);
void add_eds_cdcf(CLI::App& eds, int& exit_code);
void add_eds_fix(CLI::App& eds, int& exit_code);

}  // namespace takt
