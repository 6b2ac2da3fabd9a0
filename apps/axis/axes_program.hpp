#pragma once
#include <chrono>
#include <expected>
#include <functional>
#include <memory>
#include <string>
#include <takt/motion.hpp>
#include <vector>

#include "apps/axis/lcm_access.hpp"

namespace takt {

/// The settings that all programs that command axes have in common.
struct AxesProgram {
  std::string name;                    ///< name in events and messages: "takt-jog"
  std::string bus = {};                ///< empty: the first bus whose layout arrives
  std::vector<std::string> axes = {};  ///< names in this order; empty: all axes of the bus
  LcmAccess lcm = {};
  std::chrono::nanoseconds wait = std::chrono::seconds{10};  ///< wait for the daemon and the drives
  std::chrono::nanoseconds timeout = std::chrono::milliseconds{500};  ///< timeout as in AxesOptions
  std::string plot = {};  ///< path of a file for a picture of the motions; empty: no picture
  /// Returns the transport that the axes use instead of their connection to LCM. An empty function
  /// means that they use the connection.
  std::function<std::unique_ptr<Transport>(std::unique_ptr<Transport>)> through = {};
};

/// Returns true once a signal has come while run_program() runs.
bool program_interrupted() noexcept;

/// Opens LCM for a program that commands other outputs than those of axes.
std::expected<std::unique_ptr<AxisGroup>, Obstacle> open_group(const AxesProgram& program);

/// Opens the axes of a program. A signal interrupts their calls while run_program() runs.
std::expected<Axes, Obstacle> open_axes(const AxesProgram& program);

/// Opens the axis of a program that moves one axis. Signals interrupt it as in open_axes().
std::expected<Axes, Obstacle> open_axis(const AxesProgram& program);

/// Runs the work of a program. SIGINT, SIGTERM, SIGHUP and SIGPIPE interrupt it. Prints the
/// obstacle and returns the exit code: 0 done, 1 something blocks it, 2 wrong use, 3 no bus.
int run_program(const std::string& name, const std::function<Done()>& work);

}  // namespace takt
