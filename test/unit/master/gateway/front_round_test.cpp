#include "master/gateway/front_round.hpp"

#include <algorithm>
#include <chrono>
#include <gtest/gtest.h>
#include <string>

namespace takt {
namespace {

using namespace std::chrono_literals;

constexpr Time period = 2ms;

/// A bus thread and a front thread in virtual time. Every step of the front thread takes time. The
/// bus thread publishes when its time has come, even in the middle of a step.
class VirtualFront {
 public:
  struct Steps {
    Time first_image{};  ///< time of the publication of image 1
    Time prediction{};   ///< time from an image to the prediction of the next one
    Time before_look{};  ///< time from the start of serve() to the check for images
    Time after_look{};   ///< time from this check to the end of serve()
    Time wake_up{};      ///< time by which a wait exceeds its end
  };
  explicit VirtualFront(const Steps& steps) : steps_{steps} {}

  /// Returns the longest time for which an image waited for the front thread.
  Time longest_delay(unsigned images) {
    FrontRound round{.next_image = [this] { return next_image(); },
                     .serve = [this] { return serve(); },
                     .wait = [this](Time next, Time latest) { wait(next, latest); }};
    while (taken_ < images) round.run();
    return longest_;
  }

 private:
  Time published_at(unsigned image) const { return steps_.first_image + (image - 1) * period; }

  Time next_image() {
    unsigned predicted = 1;
    while (now_ >= published_at(predicted) + steps_.prediction) ++predicted;
    now_ += 1us;
    return published_at(predicted);
  }
  Time serve() {
    now_ += steps_.before_look;
    for (; now_ >= published_at(taken_ + 1); ++taken_) {
      longest_ = std::max(longest_, now_ - published_at(taken_ + 1));
    }
    now_ += steps_.after_look;
    return now_ + 10 * period;
  }
  void wait(Time next, Time latest) {
    now_ += std::max(Time{0}, std::min(latest - now_, pause_before_image(now_, next)));
    now_ += steps_.wake_up;
  }

  Steps steps_;
  Time now_{};
  Time longest_{};
  unsigned taken_ = 0;
};

TEST(FrontRound, NeverSleepsOverAnImageWhereverTheBusThreadPublishes) {
  for (Time phase = 1us; phase < period; phase += 3us) {
    for (const Time prediction : {0us, 2us}) {
      VirtualFront front{{.first_image = phase,
                          .prediction = prediction,
                          .before_look = 5us,
                          .after_look = 60us,
                          .wake_up = 7us}};

      EXPECT_LE(front.longest_delay(20), 200us) << "first image at " << phase.count() << " ns";
    }
  }
}

TEST(FrontRound, AsksForTheNextImageBeforeItLooksForImages) {
  std::string order;
  FrontRound round{.next_image =
                       [&] {
                         order += 'n';
                         return Time{7};
                       },
                   .serve =
                       [&] {
                         order += 's';
                         return Time{9};
                       },
                   .wait =
                       [&](Time next, Time latest) {
                         order += 'w';
                         EXPECT_EQ(next, Time{7});
                         EXPECT_EQ(latest, Time{9});
                       }};

  round.run();

  EXPECT_EQ(order, "nsnw");
}

/// Regression: after a stall in the middle of a round, the wait for the old prediction took up to
/// 20 ms.
TEST(FrontRound, DoesNotWaitWhereAnImageWasPublishedMeanwhile) {
  Time prediction{7};
  int waits = 0;
  FrontRound round{.next_image = [&] { return prediction; },
                   .serve =
                       [&] {
                         prediction = Time{14};
                         return Time{100};
                       },
                   .wait = [&](Time, Time) { ++waits; }};

  round.run();
  EXPECT_EQ(waits, 0);

  round.run();
  EXPECT_EQ(waits, 1);
}

}  // namespace
}  // namespace takt
