#pragma once
#include <algorithm>
#include <cstdlib>
#include <filesystem>
#include <vector>

namespace takt::test {

/// Written by us, without a fault.
inline std::filesystem::path own_eds_files() { return TAKT_SOURCE_DIR "/share/eds"; }
/// Written by us, with faults as vendors make them.
inline std::filesystem::path nasty_eds_files() { return TAKT_SOURCE_DIR "/test/unit/eds/data"; }
/// Files of real devices: $TAKT_CORPUS, else a folder beside the source tree. May be missing.
inline std::filesystem::path eds_corpus() {
  const char* given = std::getenv("TAKT_CORPUS");
  return given != nullptr ? std::filesystem::path{given}
                          : std::filesystem::path{TAKT_SOURCE_DIR} / "../shared/eds";
}

/// All EDS and DCF files below a folder, in order of their names.
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
