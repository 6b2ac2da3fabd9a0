#include "apps/move/set_points/taken_set_points.hpp"

#include <gtest/gtest.h>

namespace takt {
namespace {

using Vector = Eigen::Vector2d;

TEST(TakenSetPoints, AreNoneAtTheBeginning) {
  TakenSetPoints taken{Vector{1, 2}};
  taken.sent(0.002, Vector{1.1, 2.1});
  EXPECT_EQ(taken.time(), 0.0);
  taken.seen(Vector{1, 2});
  EXPECT_EQ(taken.time(), 0.0);
}

TEST(TakenSetPoints, AreThoseThatTheImageShows) {
  TakenSetPoints taken{Vector{0, 0}};
  for (int i = 1; i <= 4; ++i) taken.sent(i * 0.002, Vector{i, -i});
  taken.seen(Vector{2, -2});
  EXPECT_EQ(taken.time(), 0.004);
  taken.seen(Vector{4, -4});
  EXPECT_EQ(taken.time(), 0.008);
}

TEST(TakenSetPoints, AreTheNewestOfEquals) {
  TakenSetPoints taken{Vector{0, 0}};
  taken.sent(0.002, Vector{5, 5});
  taken.sent(0.004, Vector{5, 5});
  taken.sent(0.006, Vector{6, 6});
  taken.seen(Vector{5, 5});
  EXPECT_EQ(taken.time(), 0.004) << "a slow motion rests on one count for many cycles";
}

TEST(TakenSetPoints, AreTheNearestWhereADeviceRounds) {
  TakenSetPoints taken{Vector{0, 0}};
  taken.sent(0.002, Vector{1, 1});
  taken.sent(0.004, Vector{2, 2});
  taken.seen(Vector{1.3, 0.9});
  EXPECT_EQ(taken.time(), 0.002);
}

TEST(TakenSetPoints, NeverGoBack) {
  TakenSetPoints taken{Vector{0, 0}};
  taken.sent(0.002, Vector{1, 1});
  taken.sent(0.004, Vector{2, 2});
  taken.seen(Vector{2, 2});
  taken.seen(Vector{0, 0});
  EXPECT_EQ(taken.time(), 0.004);
}

TEST(TakenSetPoints, AreApartFromThoseOfAnotherProgram) {
  TakenSetPoints taken{Vector{0, 0}};
  EXPECT_EQ(taken.apart(), (Vector{0, 0}));
  taken.sent(0.002, Vector{1, 1});
  taken.seen(Vector{1.25, 0.5});
  EXPECT_EQ(taken.apart(), (Vector{0.25, 0.5}));
  taken.seen(Vector{1, 1});
  EXPECT_EQ(taken.apart(), (Vector{0, 0}));
}

TEST(TakenSetPoints, ForgetTheOldestOfTooMany) {
  TakenSetPoints taken{Vector{0, 0}};
  for (int i = 1; i <= 100; ++i) taken.sent(i, Vector{i, i});
  taken.seen(Vector{99, 99});
  EXPECT_EQ(taken.time(), 99);
  taken.sent(101, Vector{101, 101});
  taken.seen(Vector{101, 101});
  EXPECT_EQ(taken.time(), 101);
}

TEST(TakenSetPoints, ThatAreSentOnceMoreAreOne) {
  TakenSetPoints taken{Vector{0, 0}};
  taken.sent(1, Vector{1, 1});
  for (int i = 0; i < 100; ++i) taken.sent(1, Vector{1, 1});
  taken.seen(Vector{0, 0});
  EXPECT_EQ(taken.time(), 0);
  taken.seen(Vector{1, 1});
  EXPECT_EQ(taken.time(), 1);
}

}  // namespace
}  // namespace takt
