#pragma once
#include <functional>
#include <memory>
#include <optional>
#include <span>
#include <string>
#include <takt/motion.hpp>

#include "apps/takt/simulate/motion/motion_outcome.hpp"
#include "apps/takt/simulate/motion/motion_script.hpp"

namespace takt {

/// The code of a simulated program that commands its axes by a script, with the library that real
/// programs use. It runs on the thread of a VirtualProcess.
class MotionProgram {
 public:
  struct Setting {
    std::string bus;
    Time end_of_run;  ///< taktd begins its ordered stop
    std::function<std::unique_ptr<Transport>()> connect;
    std::function<bool()> is_killed;
  };
  /// Executes these entries of the script, and keeps an outcome for each of them.
  MotionProgram(Setting setting, const MotionScript& script, std::span<const MotionEntry> entries,
                std::span<MotionOutcome> outcomes);

  /// Executes all entries, and then waits until the program is killed.
  void run();

 private:
  bool open();
  void pass_until(Time when);
  void wait_for_end();
  void take(const MotionEntry& entry, MotionOutcome& outcome);
  Done command(const MotionEntry& entry, MotionOutcome& outcome);
  Done move_by(const MotionEntry& entry);
  Done stream(const MotionEntry& entry, MotionOutcome& outcome);
  std::optional<Time> time_of_next() const;
  void end_newest(std::string_view result, std::string text);
  void settle(MotionOutcome& outcome, const Done& done);

  Setting setting_;
  const MotionScript& script_;
  std::span<const MotionEntry> entries_;
  std::span<MotionOutcome> outcomes_;
  std::optional<Axes> axes_;
  MotionOutcome* newest_ = nullptr;  // motion that the axes may still follow
  std::optional<Time> interrupt_;    // time at which the present call has to return
  std::size_t next_ = 0;             // index of the next entry
};

}  // namespace takt
