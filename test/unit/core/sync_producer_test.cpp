#include "master/core/sync_producer.hpp"

#include <gtest/gtest.h>

#include "test/unit/core/script.hpp"

namespace takt {
namespace {

constexpr CobId sync = CobId::base(0x80);

TEST(SyncProducer, SendsNoByteWithoutCounter) {
  SyncProducer producer{sync, 0};
  EXPECT_EQ(producer.next(), make_frame(sync, {}));
  EXPECT_EQ(producer.next(), make_frame(sync, {}));
  EXPECT_EQ(producer.counter(), 0);
}

TEST(SyncProducer, CountsFromOneToTheOverflowAndNeverToZero) {
  SyncProducer two{sync, 2};
  for (const std::uint8_t counter : {std::uint8_t{1}, std::uint8_t{2}, std::uint8_t{1}}) {
    EXPECT_EQ(two.next(), make_frame(sync, {counter}));
  }
  SyncProducer most{sync, 240};
  for (int i = 1; i <= 239; ++i) most.next();
  EXPECT_EQ(most.next(), make_frame(sync, {0xF0}));
  EXPECT_EQ(most.next(), make_frame(sync, {0x01}));
}

TEST(SyncProducer, BeginsAtOneAfterStopped) {
  SyncProducer producer{sync, 4};
  producer.next();
  producer.next();
  EXPECT_EQ(producer.next(), make_frame(sync, {0x03}));
  producer.restart();
  EXPECT_EQ(producer.next(), make_frame(sync, {0x01}));
}

}  // namespace
}  // namespace takt
