#pragma once
#include <cstdint>
#include <optional>
#include <string>
#include <string_view>

#include "apps/takt/demo/child_program.hpp"
#include "apps/takt/demo/demo_files.hpp"
#include "apps/takt/demo/demo_output.hpp"
#include "eds_parser/values/time.hpp"

namespace takt {

struct DemoOptions {
  std::optional<Time> run_for;  ///< time for which the axes move; empty: until Ctrl-C
  bool still = false;           ///< true: the demo does not move the axes, and other programs may
};

/// Shortest time that takt-move accepts for the motion of the demo.
inline constexpr Time shortest_demo = std::chrono::seconds{4};

/// The demo machine: a taktd on the simulated bus, and takt-move that moves its axes. They exchange
/// their messages on a port of loopback that no other program uses. LCM_DEFAULT_URL has no effect.
class DemoRun {
 public:
  /// Throws a Failure if there is no free port.
  DemoRun(DemoFiles files, const DemoOptions& options);

  /// Returns the exit code of `takt demo`.
  int run();

 private:
  ChildProgram start(const std::filesystem::path& program, std::vector<std::string> words);
  void start_daemon();
  void start_motion();
  void serve(Time limit);
  void take_daemon_line(std::string_view line);
  void take_motion_line(std::string_view line);
  bool goes_on() const;
  void show_where_to_look();
  int end();
  int sum_up(int taktd, int takt_move);

  DemoFiles files_;
  DemoOptions options_;
  DemoOutput output_;
  std::string url_;
  std::optional<ChildProgram> daemon_;
  std::optional<ChildProgram> motion_;
  bool shown_ = false;  ///< the hint to other commands has been printed
};

}  // namespace takt
