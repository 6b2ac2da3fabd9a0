#include <fmt/format.h>
#include <string>
#include <takt/motion.hpp>

#include "apps/axis/axes_program.hpp"
#include "apps/home/home_options.hpp"
#include "apps/plot/motion/motion_plot.hpp"

namespace {

void show(const takt::Axes& axes) {
  for (Eigen::Index i = 0; i < axes.size(); ++i) {
    const std::string& unit = axes.unit(i);
    fmt::print("{} {}, its position is {:.4f} {}\n", axes.name(i),
               axes.homed(i) ? "is homed" : "is not homed", axes.positions()(i),
               unit.empty() ? "counts" : unit);
  }
}

/// Homes the axes, and disables them in any case.
takt::Done home(takt::Axes& axes, const takt::HomeOptions& options) {
  takt::Done homed = options.reset ? axes.reset() : takt::Done{};
  if (homed) homed = axes.home(options.homing);
  show(axes);
  const takt::Done disabled = axes.disable();
  return homed ? disabled : homed;
}

takt::Done run(const takt::HomeOptions& options) {
  return takt::run_with_plot(options.program, takt::open_axes,
                             [&](takt::Axes& axes) { return home(axes, options); });
}

}  // namespace

int main(int argc, char** argv) {
  const auto [options, code] = takt::parse_home(argc, argv);
  if (code) return *code;
  return takt::run_program(options.program.name, [&options] { return run(options); });
}
