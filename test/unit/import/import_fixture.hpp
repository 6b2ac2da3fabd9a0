#pragma once
#include <algorithm>
#include <filesystem>
#include <fstream>
#include <gtest/gtest.h>
#include <unistd.h>

#include "apps/import/import_report.hpp"

namespace takt::test {

/// A folder with one device file, in which bus files are judged.
class Import : public testing::Test {
 protected:
  std::filesystem::path folder_ =
      std::filesystem::temp_directory_path() / ("takt_import_" + std::to_string(getpid()));
  void SetUp() override {
    std::filesystem::create_directories(folder_);
    std::filesystem::copy_file(TAKT_SOURCE_DIR "/share/eds/takt_drive402.eds",
                               folder_ / "drive.eds",
                               std::filesystem::copy_options::overwrite_existing);
  }
  void TearDown() override { std::filesystem::remove_all(folder_); }

  ImportReport report(const std::string& text) {
    std::ofstream{folder_ / "bus.yml"} << text;
    return import_report(folder_ / "bus.yml");
  }
  static const ImportedKey& key(const ImportReport& report, const std::string& path) {
    static const ImportedKey none{.path = "none", .value = {}, .pos = {}, .why = {}};
    const auto found = std::ranges::find(report.keys, path, &ImportedKey::path);
    return found == report.keys.end() ? none : *found;
  }
};

}  // namespace takt::test
