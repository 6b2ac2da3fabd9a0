#pragma once
#include <string>
#include <string_view>
#include <takt/motion.hpp>

#include "apps/jog/dead_man.hpp"
#include "apps/jog/jog_options.hpp"
#include "apps/jog/keyboard.hpp"

namespace takt {

/// One run of takt-jog on one axis that is open: enables it, moves it while a key is held, stops it
/// and disables it.
class JogRun {
 public:
  /// `interrupted` of the options of `axes` also ends the run.
  JogRun(Axes& axes, const JogOptions& options);

  Done run();

 private:
  Done jog_for(Time time);
  Done jog_by_keys();
  /// Moves in this direction, or stops if it is 0.
  Done turn_to(int direction);
  void take_keys(Keyboard& keyboard);
  void show(std::string_view what) const;

  Axes& axes_;
  const JogOptions& options_;
  MotionBounds bounds_;
  DeadMan dead_man_;
  int direction_ = 0;  // direction in which the axis has to move now: -1, 0 or 1
  bool ends_ = false;
  Time last_look_{};
};

}  // namespace takt
