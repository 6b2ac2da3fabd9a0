#pragma once
#include <expected>
#include <filesystem>
#include <string>

namespace takt {

/// The programs and files that `takt demo` starts and reads.
struct DemoFiles {
  std::filesystem::path taktd;
  std::filesystem::path takt_move;
  std::filesystem::path network;
};

/// Finds these files relative to the program `bin/takt`, below any prefix: the programs beside it,
/// and the network in `share/takt/demo` beside the folder `bin`. The error is a sentence that names
/// the file that is missing.
std::expected<DemoFiles, std::string> find_demo_files(const std::filesystem::path& program);

}  // namespace takt
