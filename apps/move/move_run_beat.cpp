#include <algorithm>
#include <chrono>
#include <fmt/format.h>
#include <limits>

#include "apps/move/move_run.hpp"

namespace takt {
namespace {

constexpr std::chrono::milliseconds beat_tick{2};
/// Longest wait for the answer of taktd and for its next reports: this number of seconds or of
/// periods, whichever is longer.
constexpr double longest_silence = 2.0;
constexpr int silent_periods = 20;
/// Longest wait for the event that gives the reason for a stop.
constexpr int reason_images = 20;
/// Largest number of restarts of a move, and largest number of restarts in sequence that come no
/// nearer to the target.
constexpr int most_new_begins = 10;
constexpr int most_vain_begins = 3;
/// A move has come nearer to its target if the distance to the target has become shorter since the
/// newest begin by at least this part of the distance at the first begin.
constexpr double nearer = 0.01;
/// Time before a move begins again, seconds. If taktd itself was paused, it discards the commands
/// that come in the first 20 ms after the pause, and does not answer them.
constexpr double pause_before_begin = 0.1;
constexpr int signal_again = 2;

}  // namespace

std::vector<MotionLimits> MoveRun::limits() const {
  std::vector<MotionLimits> limits(sizes_.size());
  std::ranges::transform(sizes_, limits.begin(), &MoveSizes::limits);
  return limits;
}

/// Returns the bus time in seconds. The time of the newest image is counted in cycles of the bus.
/// The time since this image is measured by the clock of this machine. `newest` is the result of
/// the newest wait().
double MoveRun::bus_seconds(Input newest) const {
  if (newest == Input::fresh) return cycle_seconds();
  return cycle_seconds() + std::chrono::duration<double>(group_.age()).count();
}

/// Returns the time of the newest image in seconds, by the cycles of the bus.
double MoveRun::cycle_seconds() const {
  return period() * static_cast<double>(group_.input().cycle());
}

/// Asks taktd whether it runs motions. Returns true after its answer: a report of all axes, or the
/// event that refuses motions.
bool MoveRun::knows_beat() {
  beat_.keep_alive();
  return beat_.offered() || progress_.has_said("motion_refused");
}

/// Lets taktd run the move to this point, and watches it. If taktd has stopped the move because the
/// bus or this program paused, the move begins again as long as it comes nearer to its target.
/// Returns false if the move does not reach its end.
bool MoveRun::watch_beat(const Eigen::VectorXd& to) {
  beat_begin_.reset();
  NewBegins begins{(to - beat_.positions()).norm()};
  for (; stop_ == 0; begins.next((to - beat_.positions()).norm())) {
    if (begins.count > 0) {
      ++holds_;
      progress_.say(fmt::format("{}: the move begins again ({} of {})",
                                progress_.stop_reasons().of(beat_.id()), begins.count,
                                most_new_begins));
      wait_before_begin();
      if (restarted_) return false;
      if (stop_ != 0) return true;
    }
    beat_.begin(to, limits());
    std::string why = watch_course();
    if (restarted_) return false;
    axes_.set_positions(beat_.positions());  // so that further commands cause no jump
    const BeatMove::Course course = beat_.course();
    if (why.empty() && (stop_ != 0 || course == BeatMove::Course::done)) return true;
    if (why.empty()) why = objection(course, begins, to);
    if (!why.empty()) {
      progress_.say(why + ": stopping");
      return false;
    }
  }
  return true;
}

void MoveRun::wait_before_begin() {
  const double until = bus_seconds() + pause_before_begin;
  while (stop_ == 0 && !restarted_) {
    const Input input = group_.wait(beat_tick);
    if (input == Input::fresh) compare("move");
    if (input == Input::restarted) take_input(input);
    if (bus_seconds(input) >= until) return;
  }
}

/// Watches the move until it is over. Returns why this program has ended the move. The text is
/// empty if taktd or a signal has ended it.
std::string MoveRun::watch_course() {
  using Course = BeatMove::Course;
  const double longest = std::max(longest_silence, silent_periods * period());
  const double begin = bus_seconds();
  double news = begin;
  std::string why;
  while (true) {
    const Input input = group_.wait(beat_tick);
    if (input == Input::restarted) {
      take_input(input);
      return {};
    }
    if (input == Input::fresh) compare("move");
    const double now = bus_seconds(input);
    const Course course = beat_.course();
    if (course == Course::done) return {};
    if (course != Course::unanswered && course != Course::runs) return why;
    const bool moves = course == Course::runs || beat_.moving();
    if (input == Input::fresh && (beat_.take_news() || !moves)) news = now;
    if (course == Course::runs && !beat_begin_) beat_begin_ = now;
    if (now - news > longest) {
      beat_.stop();  // taktd may receive the messages of this program although no answer comes back
      return silence(now - cycle_seconds());
    }
    if (course == Course::unanswered && now - begin > longest) {
      why = "taktd does not answer the move";
    } else if (now > beat_end() && why.empty()) {
      why = "the move does not end in the time of --for";
    }
    if (stop_ == 0 && why.empty()) {
      beat_.keep_alive();
      continue;
    }
    beat_.stop();
    if (stop_ >= signal_again || beat_.stands_after_stop()) return why;
  }
}

/// Returns the time in bus_seconds() at which the move has to be over. This includes
/// longest_step(), by which the images may be late.
double MoveRun::beat_end() const {
  if (!options_.seconds || !beat_begin_) return std::numeric_limits<double>::infinity();
  return *beat_begin_ + *options_.seconds + longest_step();
}

/// Returns the sentence that says which messages are missing. The newest image came `seconds` ago.
std::string MoveRun::silence(double seconds) const {
  if (seconds < longest_silence / 2.0) {
    return fmt::format("taktd has reported nothing new about the move for {:g} s", longest_silence);
  }
  return fmt::format(
      "no image of bus {} has come for {:.1f} s (does taktd run, and is the network connected?)",
      group_.bus(), seconds);
}

/// Records that the move begins again at this distance from its target.
void MoveRun::NewBegins::next(double distance) {
  ++count;
  vain = distance_then - distance < nearer * whole ? vain + 1 : 0;
  distance_then = distance;
}

/// Returns why a move that taktd has ended does not begin again. The text is empty if the move may
/// begin again.
std::string MoveRun::objection(BeatMove::Course course, const NewBegins& begins,
                               const Eigen::VectorXd& to) {
  if (course == BeatMove::Course::refused) return "taktd has refused the move";
  const StopReasons& reasons = progress_.stop_reasons();
  for (int i = 0; i < reason_images && reasons.of(beat_.id()).empty(); ++i) {
    const Input input = group_.wait(std::chrono::milliseconds{100});
    progress_.states(group_);
    if (input != Input::restarted) continue;
    take_input(input);
    break;
  }
  const std::string reason = reasons.of(beat_.id());
  if (reason.empty()) return "taktd has stopped the move and has not said why";
  if (!reasons.only_paused(beat_.id())) return reason;
  if (!beat_.offered()) return reason + "; an axis is not enabled any more";
  if (begins.vain >= most_vain_begins) {
    return fmt::format(
        "{}; the move has begun again {} times and has not come nearer to its target", reason,
        begins.vain);
  }
  if (begins.count >= most_new_begins) {
    return fmt::format("{}; the move has already begun again {} times", reason, begins.count);
  }
  if (!options_.seconds || !beat_begin_) return {};
  const auto rest = SynchronisedMove::plan(beat_.positions(), to, limits());
  const double sine = options_.sine ? 1.0 / options_.frequency : 0.0;
  const double left = *options_.seconds - (bus_seconds() - *beat_begin_);
  if (rest && rest->duration() + sine <= left) return {};
  return reason + "; --for leaves no time to begin again";
}

}  // namespace takt
