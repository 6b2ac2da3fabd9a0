// What the ordered stop says of an axis that it did not confirm.
#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <string>

#include "test/simulate/lift.hpp"

namespace takt {
namespace {

using namespace std::chrono_literals;
using test::machine;
using testing::AllOf;
using testing::ElementsAre;
using testing::HasSubstr;
using testing::Not;
using testing::StartsWith;

constexpr const char* too_slow = "{index: 0x6085, value: 100}";

TEST(AxisVerdict, NamesAVelocityThatWasReadBySdoInTheUnitOfTheFile) {
  const test::Folder folder;
  const auto network = machine(
      folder,
      {.master = ", stop_timeout: 1000", .sdo = too_slow, .second_tpdo = "{enabled: false}"});
  const auto outcome = simulate(network, {.duration = 4300ms, .move = true});
  EXPECT_THAT(outcome.unconfirmed, ElementsAre(AllOf(StartsWith("z was disabled at "),
                                                     HasSubstr("m/s"), Not(HasSubstr("606C")))));
}

}  // namespace
}  // namespace takt
