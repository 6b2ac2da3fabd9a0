#include <array>
#include <gtest/gtest.h>
#include <ios>
#include <set>

#include "master/explain/emcy_text.hpp"
#include "master/wire/sdo_abort.hpp"

namespace takt {
namespace {

TEST(AbortText, KnowsThe31CodesOfCia301EachByAnotherText) {
  constexpr std::array<std::uint32_t, 31> codes{
      0x05030000, 0x05040000, 0x05040001, 0x05040002, 0x05040003, 0x05040004, 0x05040005,
      0x06010000, 0x06010001, 0x06010002, 0x06020000, 0x06040041, 0x06040042, 0x06040043,
      0x06040047, 0x06060000, 0x06070010, 0x06070012, 0x06070013, 0x06090011, 0x06090030,
      0x06090031, 0x06090032, 0x06090036, 0x060A0023, 0x08000000, 0x08000020, 0x08000021,
      0x08000022, 0x08000023, 0x08000024};
  std::set<std::string_view> seen;
  for (const auto code : codes) {
    EXPECT_NE(abort_text(code), "unknown abort code") << std::hex << code;
    EXPECT_TRUE(seen.insert(abort_text(code)).second) << abort_text(code);
  }
  EXPECT_EQ(abort_text(0x06020000), "object does not exist in the dictionary");
}

TEST(AbortText, SaysWhenACodeIsForeign) {
  for (const std::uint32_t code : {0x06010003U, 0x06010004U, 0x06010005U, 0x06010006U, 0x06090033U})
    EXPECT_TRUE(abort_text(code).ends_with("(EtherCAT)")) << std::hex << code;
  EXPECT_EQ(abort_text(0), "unknown abort code");
  EXPECT_EQ(abort_text(0xFFFFFFFF), "unknown abort code");
}

TEST(EmcyText, TakesTheMostSpecificEntry) {
  EXPECT_EQ(emcy_text(0x7121), "motor blocked");
  EXPECT_EQ(emcy_text(0x7130), "power module or motor");
  EXPECT_EQ(emcy_text(0x7F00), "additional modules");
  EXPECT_EQ(emcy_text(0x8130),
            "life guard or heartbeat error: a node that the device monitors is silent");
  EXPECT_EQ(emcy_text(0x8611), "following error");
  EXPECT_EQ(emcy_text(0x0000), "error reset or no error");
}

TEST(EmcyText, HasWordsForEveryCode) {
  for (std::uint32_t code = 0; code <= 0xFFFF; ++code) {
    ASSERT_FALSE(emcy_text(static_cast<std::uint16_t>(code)).empty());
  }
}

TEST(ErrorRegisterText, NamesTheBits) {
  EXPECT_EQ(error_register_text(0), "none");
  EXPECT_EQ(error_register_text(0x11), "generic, communication");
  EXPECT_EQ(error_register_text(0x80), "manufacturer");
}

}  // namespace
}  // namespace takt
