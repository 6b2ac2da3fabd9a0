#include "eds_parser/values/ids.hpp"

#include <gtest/gtest.h>

namespace takt {
namespace {

TEST(NodeId, ExistsOnlyFrom1To127) {
  EXPECT_FALSE(NodeId::from(0));
  EXPECT_FALSE(NodeId::from(128));
  EXPECT_EQ(NodeId::from(127)->value(), 127);
  EXPECT_EQ((5_node).value(), 5);
}

TEST(CobId, KeepsBaseAndExtendedApart) {
  EXPECT_NE(CobId::base(0x185), CobId::extended(0x185));
  EXPECT_EQ(CobId::extended(0x12345).id(), 0x12345U);
  EXPECT_EQ(to_string(CobId::base(0x85)), "0x085");
  EXPECT_EQ(to_string(CobId::extended(0x12345)), "0x00012345");
}

TEST(ObjectKey, PrintsIndexAndSubInHex) {
  EXPECT_EQ(to_string(ObjectKey{0x60FE, 0x1A}), "60FE:1A");
}

}  // namespace
}  // namespace takt
