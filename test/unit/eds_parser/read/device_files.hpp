#pragma once
#include <algorithm>
#include <cstdlib>
#include <filesystem>
#include <vector>

namespace takt::test {

/// Returns the folder of our own device files without faults.
inline std::filesystem::path own_eds_files() { return TAKT_SOURCE_DIR "/share/eds"; }
/// Returns the folder of our own device files with faults that vendors typically make.
inline std::filesystem::path nasty_eds_files() {
  return TAKT_SOURCE_DIR "/test/unit/eds_parser/read/data";
}
/// Returns the folder with files of real devices: $TAKT_CORPUS, else a folder beside the source
/// tree. The folder may be missing.
inline std::filesystem::path eds_corpus() {
  const char* given = std::getenv("TAKT_CORPUS");
  return given != nullptr ? std::filesystem::path{given}
                          : std::filesystem::path{TAKT_SOURCE_DIR} / "../shared/eds";
}

/// Returns all EDS and DCF files below a folder, sorted by name.
inline std::vector<std::filesystem::path> device_files(const std::filesystem::path& folder) {
  std::vector<std::filesystem::path> files;
  std::error_code error;
  for (const auto& entry : std::filesystem::recursive_directory_iterator{folder, error}) {
    const auto kind = entry.path().extension();
    if (kind == ".eds" || kind == ".dcf") files.push_back(entry.path());
  }
  std::ranges::sort(files);
  return files;
}

}  // namespace takt::test
