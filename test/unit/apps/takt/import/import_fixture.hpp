#pragma once
#include <algorithm>
#include <filesystem>
#include <fstream>
#include <gtest/gtest.h>
#include <unistd.h>

#include "apps/takt/import/import_report.hpp"
#include "test/support/folder.hpp"

namespace takt::test {

/// A folder with one device file, in which the tests import bus files.
class Import : public testing::Test {
 protected:
  Import() {
    std::filesystem::copy_file(TAKT_SOURCE_DIR "/share/eds/takt_drive402.eds",
                               folder_ / "drive.eds");
  }

  ImportReport report(const std::string& text) {
    return import_report(folder_.write("bus.yml", text));
  }
  static const ImportedKey& key(const ImportReport& report, const std::string& path) {
    static const ImportedKey none{.path = "none", .value = {}, .pos = {}, .why = {}};
    const auto found = std::ranges::find(report.keys, path, &ImportedKey::path);
    return found == report.keys.end() ? none : *found;
  }

  const Folder folder_;
};

}  // namespace takt::test
