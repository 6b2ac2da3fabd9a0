// `takt eds dcf` writes a DCF. `takt eds cdcf` converts it to the bytes of 0x1F22 and reads such
// bytes.
#include <fstream>
#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <string>
#include <utility>

#include "test/e2e/process.hpp"
#include "test/support/folder.hpp"

namespace takt::test {
namespace {

using testing::HasSubstr;
using testing::Not;

class EdsCdcf : public testing::Test {
 protected:
  Ended takt(std::vector<std::string> arguments) {
    arguments.insert(arguments.begin(), {TAKT, "eds"});
    return run(std::move(arguments), folder_.path());
  }
  /// Writes a DCF for the drive of share/eds as node 5, with these values.
  Ended write_dcf(const std::vector<std::string>& values) {
    std::vector<std::string> arguments{
        "dcf", TAKT_SOURCE_DIR "/share/eds/takt_drive402.eds", "--node", "5", "-o", dcf_};
    for (const auto& value : values) arguments.insert(arguments.end(), {"--set", value});
    return takt(std::move(arguments));
  }

  Folder folder_;
  std::string dcf_ = (folder_ / "axis.dcf").string();
  std::string bin_ = (folder_ / "axis.bin").string();
};

TEST_F(EdsCdcf, HoldsWhatTheDcfSetsAndIsReadAgain) {
  ASSERT_EQ(write_dcf({"6081:00=1000", "1017=100", "6060=8", "1800:02=255"}).exit_code, 0);

  ASSERT_EQ(takt({"cdcf", dcf_, "-o", bin_}).exit_code, 0);

  const Ended decoded = takt({"cdcf", "--decode", bin_});
  EXPECT_EQ(decoded.exit_code, 0);
  EXPECT_EQ(decoded.output,
            "1017:00 64 00\n"
            "1800:01 85 01 00 C0\n"
            "1800:02 FF\n"
            "1800:01 85 01 00 40\n"
            "6060:00 08\n"
            "6081:00 E8 03 00 00\n");
  const std::string bytes = read_file(bin_);
  EXPECT_EQ(bytes.substr(0, 13), std::string("\x06\0\0\0\x17\x10\0\x02\0\0\0\x64\0", 13));
  EXPECT_EQ(bytes.size(), 4 + 6 * 7 + 2 + 4 + 1 + 4 + 1 + 4);
}

TEST_F(EdsCdcf, BytesBehindTheLastEntryAreReported) {
  std::ofstream{bin_, std::ios::binary}
      << std::string("\x01\0\0\0\x17\x10\0\x02\0\0\0\x64\0\x18\x10", 15);

  const Ended decoded = takt({"cdcf", "--decode", bin_});

  EXPECT_EQ(decoded.exit_code, 0);
  EXPECT_THAT(decoded.output, HasSubstr("1017:00 64 00\n"));
  EXPECT_THAT(decoded.output, HasSubstr("axis.bin: 2 bytes follow the last of 1 entries"));
}

TEST_F(EdsCdcf, GoesToStdoutAsWell) {
  ASSERT_EQ(write_dcf({"1017=100"}).exit_code, 0);

  const Ended piped = takt({"cdcf", dcf_, "-o", "-"});

  EXPECT_EQ(piped.exit_code, 0);
  EXPECT_EQ(piped.output, std::string("\x01\0\0\0\x17\x10\0\x02\0\0\0\x64\0", 13));
}

TEST_F(EdsCdcf, TheDifferenceOfAUtf16FileIsDeclaredToBeForTheEyeOnly) {
  const std::string text = "[1017]\nParameterName=x\nDataType=6\nAccessType=rw\nDefaultValue=08\n";
  std::string wide{"\xFF\xFE"};
  for (const char c : text) wide += {c, '\0'};
  std::ofstream{folder_ / "wide.eds", std::ios::binary} << wide;
  const auto file = (folder_ / "wide.eds").string();
  const auto mended = (folder_ / "mended.eds").string();

  const Ended shown = takt({"fix", file});
  EXPECT_THAT(shown.output,
              HasSubstr("can't be applied with patch; -o writes the corrected file\n"));
  const Ended written = takt({"fix", file, "-o", mended});
  EXPECT_THAT(written.output, HasSubstr("can't be applied with patch; the output is complete\n"));
  EXPECT_THAT(read_file(mended), HasSubstr("AccessType=rw\nDefaultValue=8\n"));
  EXPECT_THAT(takt({"fix", mended}).output, Not(HasSubstr("patch")));
}

TEST_F(EdsCdcf, TakesTheNodeIdThatIsGiven) {
  std::ofstream{folder_ / "any.eds"}
      << "[1014]\nParameterName=x\nDataType=7\nAccessType=rw\nParameterValue=$NODEID+0x80\n";
  const auto file = (folder_ / "any.eds").string();

  ASSERT_EQ(takt({"cdcf", file, "--node", "9", "-o", bin_}).exit_code, 0);

  EXPECT_EQ(takt({"cdcf", "--decode", bin_}).output, "1014:00 89 00 00 00\n");
}

TEST_F(EdsCdcf, WritesNothingWhereThereIsNothingOrAnError) {
  const Ended none = takt({"cdcf", TAKT_SOURCE_DIR "/share/eds/takt_io401.eds", "-o", bin_});
  EXPECT_EQ(none.exit_code, 1);
  EXPECT_THAT(none.output, HasSubstr("no object has a ParameterValue that can be written"));

  std::ofstream{folder_ / "bad.dcf"} << "[DeviceComissioning]\nNodeID=5\n[1017]\nParameterName=x\n"
                                        "DataType=6\nAccessType=rw\nParameterValue=fast\n";
  const Ended bad = takt({"cdcf", (folder_ / "bad.dcf").string(), "-o", bin_});
  EXPECT_EQ(bad.exit_code, 1);
  EXPECT_THAT(bad.output, HasSubstr("bad.dcf:7:16: error: "));
  EXPECT_FALSE(std::filesystem::exists(bin_));
}

TEST_F(EdsCdcf, SaysWhereAConciseDcfEndsTooEarly) {
  std::ofstream{bin_, std::ios::binary} << std::string("\x02\0\0\0\x17\x10\0\x02\0\0\0\x64\0", 13);

  const Ended decoded = takt({"cdcf", "--decode", bin_});

  EXPECT_EQ(decoded.exit_code, 1);
  EXPECT_THAT(decoded.output, HasSubstr("ends within entry 2 of 2"));
}

}  // namespace
}  // namespace takt::test
