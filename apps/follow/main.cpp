#include <takt/motion.hpp>

#include "apps/axis/axes_program.hpp"
#include "apps/follow/follow_options.hpp"
#include "apps/follow/follow_run.hpp"
#include "apps/plot/motion/motion_plot.hpp"

namespace {

takt::Done run(const takt::FollowOptions& options) {
  return takt::run_with_plot(options.program, takt::open_axis, [&](takt::Axes& axis) {
    return takt::FollowRun{axis, options}.run();
  });
}

}  // namespace

int main(int argc, char** argv) {
  const auto [options, code] = takt::parse_follow(argc, argv);
  if (code) return *code;
  return takt::run_program(options.program.name, [&options] { return run(options); });
}
