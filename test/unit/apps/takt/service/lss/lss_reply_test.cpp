#include "apps/takt/service/lss/lss_reply.hpp"

#include <array>
#include <gmock/gmock.h>
#include <gtest/gtest.h>

namespace takt {
namespace {

using ::testing::HasSubstr;

const std::array<LssCommand, 2> find{LssCommand{.op = LssOp::switch_global},
                                     LssCommand{.op = LssOp::fast_scan}};

std::vector<std::byte> packed(const std::vector<LssResult>& results) {
  std::vector<std::byte> bytes(results.size() * lss_result_bytes);
  for (std::size_t i = 0; i < results.size(); ++i) {
    pack(results[i], std::span{bytes}.subspan(i * lss_result_bytes).first<lss_result_bytes>());
  }
  return bytes;
}

TEST(LssReply, HasOneResultForEachService) {
  const auto results = lss_results(
      packed({{.op = LssOp::switch_global}, {.op = LssOp::fast_scan, .numbers = {1, 2, 3, 4}}}),
      find);

  ASSERT_TRUE(results) << results.error();
  ASSERT_EQ(results->size(), 2U);
  EXPECT_EQ(results->back().numbers, (std::array<std::uint32_t, 4>{1, 2, 3, 4}));
}

TEST(LssReply, EndsWithTheServiceThatFailed) {
  const auto results =
      lss_results(packed({{.op = LssOp::switch_global, .outcome = LssOutcome::refused}}), find);

  ASSERT_TRUE(results) << results.error();
  EXPECT_EQ(results->size(), 1U);
}

TEST(LssReply, IsRefusedWithoutAResultOfEachService) {
  EXPECT_EQ(lss_results({}, find).error(),
            "sent a reply of 0 bytes to 2 LSS services: it has too few results");
  const auto one = lss_results(packed({{.op = LssOp::switch_global}}), find);
  ASSERT_FALSE(one);
  EXPECT_THAT(one.error(), HasSubstr("reply of 24 bytes to 2 LSS services: it has too few"));
}

TEST(LssReply, IsRefusedIfItsResultsAreNotThoseOfTheServices) {
  const LssResult done{.op = LssOp::switch_global};
  const LssResult failed{.op = LssOp::switch_global, .outcome = LssOutcome::silent};
  const LssResult found{.op = LssOp::fast_scan};

  EXPECT_THAT(lss_results(packed({done, found, found}), find).error(), HasSubstr("too many"));
  EXPECT_THAT(lss_results(packed({found, done}), find).error(), HasSubstr("another service"));
  EXPECT_THAT(lss_results(packed({failed, found}), find).error(), HasSubstr("service that failed"));
  auto cut = packed({done, found});
  cut.pop_back();
  EXPECT_THAT(lss_results(cut, find).error(), HasSubstr("its last result is incomplete"));
}

TEST(LssReply, OfAnyBytesIsReadOrRefused) {
  for (int value = 0; value < 256; ++value) {
    for (std::size_t size = 0; size <= 3 * lss_result_bytes; ++size) {
      const std::vector<std::byte> bytes(size, static_cast<std::byte>(value));
      const auto results = lss_results(bytes, find);
      if (!results) continue;
      EXPECT_FALSE(results->empty());
      EXPECT_EQ(results->back().outcome == LssOutcome::done, results->size() == find.size());
    }
  }
}

}  // namespace
}  // namespace takt
