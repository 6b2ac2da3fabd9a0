#include "eds_parser/table/sdo_access.hpp"

#include <gtest/gtest.h>

namespace takt {
namespace {

TEST(SdoAccess, HasTheDefaultChannelOfTheNodeUnlessAnotherIsGiven) {
  const SdoChannel other{CobId::base(0x645), CobId::base(0x5C5)};
  EXPECT_EQ(SdoAccess{}.channel_of(5_node), (SdoChannel{CobId::base(0x605), CobId::base(0x585)}));
  EXPECT_EQ(SdoAccess{.channel = other}.channel_of(5_node), other);
}

}  // namespace
}  // namespace takt
