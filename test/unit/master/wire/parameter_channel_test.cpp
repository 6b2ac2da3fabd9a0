#include "master/wire/parameter_channel.hpp"

#include <gtest/gtest.h>
#include <vector>

namespace takt {
namespace {

namespace channel = parameter_channel;
using Bytes = std::vector<std::uint8_t>;

// The example of the fact sheet: node 3, P15.13 := 1
TEST(ParameterChannel, AsksAsTheCardExpects) {
  EXPECT_EQ(channel::request(channel::Command::write, 0x0F0D, 1),
            (channel::Bytes8{0x02, 0x00, 0x0D, 0x0F, 0x01, 0x00, 0x00, 0x00}));
  EXPECT_EQ(channel::request(channel::Command::read, 0x0F0D, 0),
            (channel::Bytes8{0x01, 0x00, 0x0D, 0x0F, 0x00, 0x00, 0x00, 0x00}));
}

TEST(ParameterChannel, ReadsAnswersAndErrors) {
  const auto good = channel::answer(Bytes{0x01, 0, 0, 0, 0x78, 0x56, 0x34, 0x12});
  ASSERT_TRUE(good);
  EXPECT_TRUE(good->done);
  EXPECT_EQ(good->value, 0x12345678U);

  const auto refused = channel::answer(Bytes{0x03, 0, 0x07, 0, 0, 0, 0, 0});
  ASSERT_TRUE(refused);
  EXPECT_FALSE(refused->done);
  EXPECT_EQ(refused->error, 7);
  EXPECT_EQ(channel::error_text(7), "the parameter is read-only");
  EXPECT_EQ(channel::error_text(99), "unknown error code");
}

TEST(ParameterChannel, DoesNotTakeWhatIsNoAnswer) {
  EXPECT_FALSE(channel::answer(Bytes{0x01, 0, 0, 0, 1, 0, 0}));
  EXPECT_FALSE(channel::answer(Bytes{0x00, 0, 0, 0, 0, 0, 0, 0})) << "no request";
  EXPECT_FALSE(channel::answer(Bytes{0x02, 0, 0, 0, 0, 0, 0, 0}));
}

}  // namespace
}  // namespace takt
