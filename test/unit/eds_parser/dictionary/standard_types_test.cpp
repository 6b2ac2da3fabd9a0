#include "eds_parser/dictionary/standard_types.hpp"

#include <gtest/gtest.h>
#include <ios>

namespace takt {
namespace {

// CiA 301, 7.5.2.35 and 7.5.2.37: the communication record of a PDO.
TEST(StandardType, OfACommunicationRecordFollowsFromTheSubIndex) {
  constexpr DataType types[]{DataType::unsigned8,  DataType::unsigned32, DataType::unsigned8,
                             DataType::unsigned16, DataType::unsigned8,  DataType::unsigned16,
                             DataType::unsigned8,  DataType::unknown};
  for (const unsigned index : {0x1400U, 0x15FFU, 0x1800U, 0x19FFU}) {
    for (std::uint8_t sub = 0; sub < std::size(types); ++sub) {
      EXPECT_EQ(standard_type({static_cast<std::uint16_t>(index), sub}), types[sub])
          << std::hex << index << ":" << unsigned{sub};
    }
  }
}

}  // namespace
}  // namespace takt
