#include "eds_parser/print/plan/pdo_picture.hpp"

#include <gmock/gmock.h>

#include "test/unit/eds_parser/plan/tiny_network.hpp"

namespace takt {
namespace {

using test::compile;
using testing::ElementsAre;

TEST(PdoPicture, HasAColumnForEachBitAndDotsWhereNothingIsMapped) {
  const auto net = compile(
      "arm: {node_id: 5, dcf: x, rpdo: {1: {transmission: 255, mapping: "
      "[{index: 0x6060}, {index: 0x0005}, {index: 0x6040}]}}}\n");

  ASSERT_FALSE(net.plan.pdos.rpdos.empty());
  EXPECT_THAT(pdo_picture(net.plan, net.plan.pdos.rpdos[0]),
              ElementsAre("0       1       2       3",  //
                          "|6060:00........|6040:00 control|"));
}

}  // namespace
}  // namespace takt
