#include <gtest/gtest.h>
#include <takt/drive402.hpp>

namespace takt {
namespace {

using enum State402;

struct Case {
  std::uint16_t statusword;
  std::optional<State402> state;
};

class Statusword : public testing::TestWithParam<Case> {};

TEST_P(Statusword, ReportsTheState) {
  EXPECT_EQ(decode_statusword(GetParam().statusword), GetParam().state);
}

INSTANTIATE_TEST_SUITE_P(
    Table, Statusword,
    testing::Values(Case{0x0000, not_ready_to_switch_on}, Case{0x0020, not_ready_to_switch_on},
                    Case{0x0250, switch_on_disabled}, Case{0x0270, switch_on_disabled},
                    Case{0x0040, switch_on_disabled}, Case{0x0231, ready_to_switch_on},
                    Case{0x0221, ready_to_switch_on}, Case{0x0233, switched_on},
                    Case{0x0237, operation_enabled}, Case{0x1637, operation_enabled},
                    Case{0x0217, quick_stop_active}, Case{0x021F, fault_reaction_active},
                    Case{0x023F, fault_reaction_active}, Case{0x0218, fault}, Case{0x0238, fault},
                    Case{0x0008, fault}, Case{0x0201, std::nullopt}, Case{0x0002, std::nullopt},
                    Case{0x0041, std::nullopt}));

TEST(State402, HasAName) { EXPECT_EQ(name(operation_enabled), "operation enabled"); }

}  // namespace
}  // namespace takt
