#pragma once
#include <cstddef>

#include "master/motion/beat/motion_order.hpp"

namespace takt::motion {

/// Gives the states of a motion at times that only increase. It passes each segment once, so that a
/// cycle takes as long for a long motion as for a short one.
class ProfilePlayer {
 public:
  ProfilePlayer() noexcept = default;
  ProfilePlayer(const Profile& profile, const State& from, Ending ending) noexcept
      : profile_{profile}, start_{from}, duration_{profile.duration()}, ending_{ending} {
    if (profile.segments().empty()) end();
  }

  /// Returns the state `time` seconds after the start.
  State at(double time) noexcept {
    const auto segments = profile_.segments();
    while (segment_ < segments.size() && time - passed_ >= segments[segment_].duration) {
      const Segment& segment = segments[segment_++];
      start_ = advanced(start_, segment.duration, segment.jerk);
      passed_ += segment.duration;
      if (segment_ == segments.size()) end();
    }
    const double jerk = is_over() ? 0.0 : segments[segment_].jerk;
    return advanced(start_, time - passed_, jerk);
  }

  bool is_over() const noexcept { return segment_ >= profile_.segments().size(); }
  Ending ending() const noexcept { return ending_; }
  double duration() const noexcept { return duration_; }  ///< s

  template <class Archive>
  void keep(Archive& state) noexcept {
    state(profile_, start_, passed_, duration_, ending_);
    state.position(segment_, Profile::capacity + 1);
  }

 private:
  /// Sets the acceleration at the end to 0. Rounding leaves a small acceleration, with which the
  /// axis would drift.
  void end() noexcept {
    start_.acceleration = 0.0;
    if (ending_ == Ending::rest) start_.velocity = 0.0;
  }

  Profile profile_;
  State start_;  ///< state at the start of the segment
  double passed_ = 0.0;
  double duration_ = 0.0;
  std::size_t segment_ = 0;
  Ending ending_ = Ending::rest;
};

}  // namespace takt::motion
