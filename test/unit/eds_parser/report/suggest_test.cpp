#include "eds_parser/report/suggest.hpp"

#include <array>
#include <gtest/gtest.h>

namespace takt {
namespace {

constexpr std::array<std::string_view, 3> keys{"node_id", "heartbeat_producer", "dcf"};

TEST(Suggestion, IsAWordThatDiffersInFewLetters) {
  EXPECT_EQ(nearest("nodeid", keys), "node_id");
  EXPECT_EQ(nearest("Node-ID", keys), "node_id");
  EXPECT_EQ(nearest("hartbeat_produecr", keys), "heartbeat_producer");
  EXPECT_EQ(nearest("dfc", keys), "dcf");
}

TEST(Suggestion, IsAWordThatBeginsLikeIt) {
  EXPECT_EQ(nearest("heart", keys), "heartbeat_producer");
  EXPECT_EQ(nearest("hea", keys), "") << "too short for a guess";
}

TEST(Suggestion, IsNoWordThatOnlyEndsLikeIt) {
  EXPECT_EQ(nearest("producer", keys), "");
  EXPECT_EQ(nearest("", keys), "");
}

}  // namespace
}  // namespace takt
