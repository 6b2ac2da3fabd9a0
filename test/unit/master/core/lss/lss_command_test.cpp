#include "master/core/lss/lss_command.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <set>

#include "master/core/lss/lss_master.hpp"

namespace takt {
namespace {

using namespace std::chrono_literals;

constexpr LssOp every[]{LssOp::switch_global,
                        LssOp::configure_node_id,
                        LssOp::configure_bit_timing,
                        LssOp::activate_bit_timing,
                        LssOp::store,
                        LssOp::switch_selective,
                        LssOp::identify,
                        LssOp::identify_unconfigured,
                        LssOp::fast_scan,
                        LssOp::inquire_vendor,
                        LssOp::inquire_product,
                        LssOp::inquire_revision,
                        LssOp::inquire_serial,
                        LssOp::inquire_node_id,
                        LssOp::slow_scan};

TEST(LssFailureText, NamesEachServiceByAnotherText) {
  std::set<std::string> texts;
  for (const LssOp op : every) {
    EXPECT_EQ(lss_failure_text({.op = op}), "");
    const std::string text = lss_failure_text({.op = op, .outcome = LssOutcome::silent});
    EXPECT_FALSE(text.starts_with(':')) << text;
    texts.insert(text);
  }
  EXPECT_EQ(texts.size(), std::size(every));
}

TEST(LssResult, IsUnpackedAsItWasPacked) {
  const LssResult result{.op = LssOp::slow_scan,
                         .outcome = LssOutcome::refused,
                         .error = 2,
                         .specific = 3,
                         .numbers = {0x11223344, 5, 6, 0xFFEEDDCC},
                         .frames = 7};
  std::array<std::byte, lss_result_bytes> bytes{};
  pack(result, bytes);
  const LssResult back = unpack_lss_result(bytes);

  EXPECT_EQ(bytes[4], std::byte{0x44});
  EXPECT_EQ(bytes[16], std::byte{0xCC});
  EXPECT_EQ(back.op, result.op);
  EXPECT_EQ(back.outcome, result.outcome);
  EXPECT_EQ(back.error, result.error);
  EXPECT_EQ(back.specific, result.specific);
  EXPECT_EQ(back.numbers, result.numbers);
  EXPECT_EQ(back.frames, result.frames);
}

TEST(LssMaster, WaitsUntilTheTimeOutOfItsRequest) {
  LssMaster master;
  EXPECT_EQ(master.deadline(), never);
  master.begin({.op = LssOp::inquire_vendor}, 300ms, 5s);
  EXPECT_LE(master.deadline(), 5s);
  Outbox out;
  master.on_time(5s, out);

  EXPECT_EQ(out.frames().size(), 1U);
  EXPECT_EQ(master.deadline(), 5s + 300ms);
}

}  // namespace
}  // namespace takt
