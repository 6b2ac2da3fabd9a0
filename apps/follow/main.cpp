#include <takt/motion.hpp>

#include "apps/axis/axes_program.hpp"
#include "apps/follow/follow_options.hpp"
#include "apps/follow/follow_run.hpp"

namespace {

takt::Done run(const takt::FollowOptions& options) {
  auto axis = takt::open_axis(options.program);
  if (!axis) return std::unexpected{axis.error()};
  return takt::FollowRun{*axis, options}.run();
}

}  // namespace

int main(int argc, char** argv) {
  const auto [options, code] = takt::parse_follow(argc, argv);
  if (code) return *code;
  return takt::run_program(options.program.name, [&options] { return run(options); });
}
