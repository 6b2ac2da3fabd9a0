#include <takt/motion.hpp>

#include "apps/axis/axes_program.hpp"
#include "apps/jog/jog_options.hpp"
#include "apps/jog/jog_run.hpp"
#include "apps/jog/keyboard.hpp"
#include "apps/plot/motion/motion_plot.hpp"

namespace {

takt::Done run(const takt::JogOptions& options) {
  using takt::Obstacle;
  if (!options.seconds && !takt::Keyboard::exists()) {
    return std::unexpected{
        Obstacle{.kind = Obstacle::Kind::wrong_use,
                 .text = "stdin is not a terminal, so keys can't be read: give --for TIME"}};
  }
  return takt::run_with_plot(options.program, takt::open_axis,
                             [&](takt::Axes& axis) { return takt::JogRun{axis, options}.run(); });
}

}  // namespace

int main(int argc, char** argv) {
  const auto [options, code] = takt::parse_jog(argc, argv);
  if (code) return *code;
  return takt::run_program(options.program.name, [&options] { return run(options); });
}
