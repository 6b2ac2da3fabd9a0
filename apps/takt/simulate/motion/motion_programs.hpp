#pragma once
#include <cstddef>
#include <memory>
#include <string>
#include <vector>

#include "apps/takt/simulate/motion/motion_observer.hpp"
#include "apps/takt/simulate/motion/motion_program.hpp"
#include "apps/takt/simulate/motion/virtual_process.hpp"
#include "apps/takt/simulate/program/agenda.hpp"
#include "eds_parser/table/bus_plan.hpp"

namespace takt {

/// Returns the names of the axes that taktd can move, in the order of motion_axes().
std::vector<std::string> motion_axis_names(const BusPlan& plan);
/// Returns the names of the speed axes, in the order of BusPlan::speed_axes.
std::vector<std::string> speed_axis_names(const BusPlan& plan);

/// The programs of a run that command motions by scripts, beside the taktd of the run. A program
/// starts with the run. At an entry of the kind `kill`, it is killed and starts again.
class MotionPrograms {
 public:
  /// `end_of_run` is the time at which taktd begins its ordered stop.
  MotionPrograms(const BusPlan& plan, const MotionScripts& scripts, VirtualLcm& lcm,
                 const Clocks& clocks, sim::Random random, Time end_of_run);

  void join(Stage& stage);
  /// Call this with each image of taktd.
  void see(const ImageView& image) { observer_.see(image); }
  /// Ends all programs, and returns an outcome of each entry, in the order of the file.
  std::vector<MotionOutcome> end();

 private:
  /// One program of the scripts.
  struct Program {
    const MotionScript& script;
    std::size_t first_outcome;
    std::unique_ptr<VirtualProcess> process;
    std::unique_ptr<MotionProgram> code{};
    std::size_t next = 0;  ///< first entry of the process that starts next
  };
  /// Kills programs at their times.
  class Killer final : public Actor {
   public:
    Time next() const noexcept override { return agenda.next(); }
    void act(Time now) override { agenda.act(now); }
    Agenda agenda;
  };

  void start(Program& program);
  void kill(Program& program, Time now);

  const BusPlan& plan_;
  Time end_of_run_;
  std::vector<MotionOutcome> outcomes_;
  MotionObserver observer_;
  Killer killer_;
  std::vector<Program> programs_;
};

}  // namespace takt
