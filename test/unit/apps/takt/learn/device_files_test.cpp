#include "apps/takt/learn/device_files.hpp"

#include <filesystem>
#include <fmt/format.h>
#include <fstream>
#include <gtest/gtest.h>
#include <unistd.h>

#include "test/support/folder.hpp"

namespace takt::learn {
namespace {

namespace fs = std::filesystem;

/// A folder with an EDS and a subfolder that may not be read. The tests run without root rights.
class DeviceFolder : public testing::Test {
 protected:
  DeviceFolder() {
    fs::create_directories(folder / "shut");
    fs::copy_file(TAKT_SOURCE_DIR "/share/eds/takt_drive402.eds", folder / "takt_drive402.eds");
    fs::permissions(folder.path(), fs::perms{0755});
    fs::permissions(folder / "takt_drive402.eds", fs::perms{0644});
    fs::permissions(folder / "shut", fs::perms::none);
    is_root = ::geteuid() == 0 && ::seteuid(nobody) == 0;
  }
  ~DeviceFolder() override {
    EXPECT_TRUE(!is_root || ::seteuid(0) == 0);
    fs::permissions(folder / "shut", fs::perms::owner_all);
  }
  static constexpr uid_t nobody = 65534;
  static constexpr SeenIdentity drive{.vendor_id = 0xABCD, .product_code = 0x402};

  bool is_root = false;
  const test::Folder folder;
  DeviceFiles files;
  Findings findings;
};

TEST_F(DeviceFolder, PassesOverAFolderThatIsShut) {
  files.add_folder(folder.path(), findings);

  EXPECT_TRUE(findings.empty()) << findings[0].message;
  EXPECT_FALSE(files.find(1, drive).path.empty());
}

TEST_F(DeviceFolder, ReportsThatItIsShutItself) {
  files.add_folder(folder / "shut", findings);

  ASSERT_EQ(findings.size(), 1U);
  EXPECT_EQ(findings[0].message, "Permission denied");
}

TEST(DeviceFiles, AVendorIdOfZeroNeedsAProductCodeAndTheDeviceType) {
  const test::Folder folder;
  const fs::path path = folder.write(
      "nobody.eds",
      "[MandatoryObjects]\nSupportedObjects=2\n1=0x1000\n2=0x1018\n"
      "[1000]\nParameterName=Device type\nDataType=0x0007\nAccessType=ro\nDefaultValue=0xF0191\n"
      "[1018]\nParameterName=Identity\nObjectType=9\nSubNumber=2\n"
      "[1018sub0]\nParameterName=Count\nDataType=5\nAccessType=ro\nDefaultValue=2\n"
      "[1018sub2]\nParameterName=Product\nDataType=7\nAccessType=ro\nDefaultValue=1\n");
  DeviceFiles files;
  Findings findings;
  files.add_file(path, findings);

  const auto found = files.find(1, {.device_type = 0xF0191, .vendor_id = 0, .product_code = 1});

  EXPECT_EQ(found.path, path);
  EXPECT_TRUE(files.find(1, {.device_type = 0x20192, .product_code = 1}).path.empty());
  EXPECT_TRUE(files.find(1, {.device_type = 0xF0191}).path.empty());
}

}  // namespace
}  // namespace takt::learn
