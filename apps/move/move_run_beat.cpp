#include <algorithm>
#include <chrono>

#include "apps/move/move_run.hpp"

namespace takt {
namespace {

constexpr std::chrono::milliseconds beat_tick{2};
/// Longest wait for the answer of taktd, and for an image after a signal.
constexpr std::chrono::seconds longest_answer{2};
constexpr int signal_again = 2;

}  // namespace

std::vector<MotionLimits> MoveRun::limits() const {
  std::vector<MotionLimits> limits(sizes_.size());
  std::ranges::transform(sizes_, limits.begin(), &MoveSizes::limits);
  return limits;
}

/// Asks taktd whether it runs motions. Returns true after its answer: a report of all axes, or the
/// event that refuses motions.
bool MoveRun::knows_beat() {
  beat_.keep_alive();
  return beat_.offered() || progress_.has_said("motion_refused");
}

/// Lets taktd run the move to this point, and watches it. Where SYNC or this program pauses, taktd
/// stops the axes; the move begins again while all of them are enabled. Returns false if it does
/// not come to its end.
bool MoveRun::watch_beat(const Eigen::VectorXd& to) {
  using Course = BeatMove::Course;
  Course course = Course::stopped;
  while (course == Course::stopped && stop_ == 0 && beat_.offered()) {
    beat_.begin(to, limits());
    course = watch_course();
    if (restarted_) return false;
    axes_.set_positions(beat_.positions());  // so that further commands are no jump
    if (course == Course::stopped && stop_ == 0) ++holds_;
  }
  if (course == Course::done || stop_ != 0) return true;
  progress_.say(course == Course::unanswered ? "taktd does not answer the move: stopping"
                                             : "taktd has ended the move: stopping");
  return false;
}

BeatMove::Course MoveRun::watch_course() {
  using Course = BeatMove::Course;
  const auto until = std::chrono::steady_clock::now() + longest_answer;
  while (true) {
    const Input input = group_.wait(beat_tick);
    if (input == Input::restarted) take_input(input);
    if (input == Input::fresh) compare("move");
    const Course course = beat_.course();
    const bool late = std::chrono::steady_clock::now() > until || stop_ != 0;
    const bool lost = stop_ >= signal_again || (stop_ != 0 && group_.age() > longest_answer);
    if (restarted_ || lost || (course == Course::unanswered && late)) return course;
    if (course != Course::unanswered && course != Course::runs) return course;
    if (stop_ == 0) {
      beat_.keep_alive();
    } else {
      beat_.stop();
    }
  }
}

}  // namespace takt
