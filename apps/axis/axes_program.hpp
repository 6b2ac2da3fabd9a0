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

/// What the programs that command axes have in common.
struct AxesProgram {
  std::string name;                    ///< name in events and messages: "takt-jog"
  std::string bus = {};                ///< empty: the first bus whose layout arrives
  std::vector<std::string> axes = {};  ///< names in this order; empty: all axes of the bus
  LcmAccess lcm = {};
  std::chrono::nanoseconds wait = std::chrono::seconds{10};  ///< wait for the daemon and the drives
  std::chrono::nanoseconds timeout = std::chrono::milliseconds{500};  ///< as in AxesOptions
  std::string plot = {};  ///< file for a picture of the motions; empty: none
  /// Returns what the axes use in the place of their connection to LCM. Empty: the connection.
  std::function<std::unique_ptr<Transport>(std::unique_ptr<Transport>)> through = {};
};

/// Returns true once a signal has come while run_program() runs.
bool program_interrupted() noexcept;

/// Opens LCM for a program that commands other outputs than those of axes.
std::expected<std::unique_ptr<AxisGroup>, Obstacle> open_group(const AxesProgram& program);

/// Opens the axes of a program. A signal interrupts their calls while run_program() runs.
std::expected<Axes, Obstacle> open_axes(const AxesProgram& program);

/// As above, for a program that moves one axis.
std::expected<Axes, Obstacle> open_axis(const AxesProgram& program);

/// Runs the work of a program. SIGINT, SIGTERM, SIGHUP and SIGPIPE interrupt it. Prints the
/// obstacle and returns the exit code: 0 done, 1 something blocks it, 2 wrong use, 3 no bus.
int run_program(const std::string& name, const std::function<Done()>& work);

}  // namespace takt
