// The sentence about an output that takes its fallback.
#include <gtest/gtest.h>

#include "master/core/command_limit.hpp"
#include "master/explain/boot_report.hpp"
#include "test/unit/master/core/pdo/small_plan.hpp"

namespace takt::test {
namespace {

class FallbackText : public testing::Test {
 protected:
  std::string reported(const std::array<std::uint8_t, 8>& limit = {}) const {
    return describe(plan, {.kind = EventKind::fallback_begun,
                           .node = 1,
                           .detail = 1,
                           .value = target,
                           .bytes = limit});
  }
  static constexpr SignalIndex target = 6;
  BusPlan plan = axes({.fallback_cycles = 25});  // of 2 ms
};

TEST_F(FallbackText, NamesTheKeyThatIsConfigured) {
  EXPECT_EQ(reported(),
            "node 1 'axis1': no fresh command for signal (607A:00) within 50 ms "
            "(on_timeout: after): its fallback is sent");

  plan.layout.signals[target].fallback_key = TimeToLiveKey::after_cycles;
  EXPECT_EQ(reported(),
            "node 1 'axis1': no fresh command for signal (607A:00) within 25 cycles "
            "(on_timeout: after_cycles): its fallback is sent");
}

TEST_F(FallbackText, NamesTheShorterTimeOfTheCommand) {
  plan.layout.signals[target].fallback_key = TimeToLiveKey::after_cycles;
  EXPECT_EQ(reported(pack_limit({.cycles = 10, .origin = LimitOrigin::command})),
            "node 1 'axis1': no fresh command for signal (607A:00) within 20 ms (time_to_live of "
            "the command): its fallback is sent");
}

}  // namespace
}  // namespace takt::test
