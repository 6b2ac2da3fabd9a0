#pragma once
#include <expected>
#include <functional>
#include <memory>
#include <string>
#include <takt/axis.hpp>
#include <takt/lcm.hpp>
#include <takt/motion.hpp>
#include <vector>

#include "apps/axis/axes_program.hpp"
#include "apps/plot/motion/motion_trace.hpp"

namespace takt {

/// The file of `--plot`: a picture of the commanded and the actual motion of the axes of a run,
/// from the motion_t of each cycle. Without a file name, nothing happens.
class MotionPlot {
 public:
  /// `title` is that of the picture.
  MotionPlot(std::string file, std::string title);

  /// Creates the file, so that a wrong name is found before an axis moves. On failure, returns a
  /// sentence for the user.
  std::expected<void, std::string> create() const;
  /// Returns a transport that passes on the messages that `lcm` receives. This object keeps the
  /// motions in them, and must outlive the transport.
  std::unique_ptr<Transport> listen(std::unique_ptr<Transport> lcm);
  /// Writes the picture of these axes. On failure, returns a sentence for the user.
  std::expected<void, std::string> write(AxisGroup& group,
                                         const std::vector<std::string>& names) const;

 private:
  std::string file_;
  std::string title_;
  std::unique_ptr<MotionTrace> trace_;
};

/// Opens the axes of a program, runs `work`, and writes the picture of the run into
/// AxesProgram::plot, even if `work` ends with an obstacle.
Done run_with_plot(AxesProgram program,
                   const std::function<std::expected<Axes, Obstacle>(const AxesProgram&)>& open,
                   const std::function<Done(Axes&)>& work);

}  // namespace takt
