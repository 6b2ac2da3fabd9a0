#pragma once
#include <string_view>
#include <takt/motion.hpp>

#include "apps/follow/follow_options.hpp"

namespace takt {

/// One run of takt-follow on one axis that is open: enables it, lets it follow its leader, stops it
/// and disables it.
class FollowRun {
 public:
  /// `interrupted` of the options of `axes` also ends the run.
  FollowRun(Axes& axes, const FollowOptions& options) : axes_{axes}, options_{options} {}

  Done run();

 private:
  Done follow();
  void show(std::string_view what) const;

  Axes& axes_;
  const FollowOptions& options_;
};

}  // namespace takt
