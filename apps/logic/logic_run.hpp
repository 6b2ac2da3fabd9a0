#pragma once
#include <cstdint>
#include <functional>
#include <optional>
#include <string>
#include <takt/axis.hpp>
#include <takt/motion.hpp>
#include <vector>

#include "apps/logic/logic_options.hpp"
#include "apps/logic/logic_program.hpp"
#include "apps/logic/logic_trace.hpp"

namespace takt {

/// One run of takt-logic on one bus: evaluates the rules with each image and sends the outputs.
class LogicRun {
 public:
  /// `interrupted` ends the run.
  LogicRun(AxisGroup& group, const LogicOptions& options, std::vector<Rule> rules,
           std::function<bool()> interrupted);

  Done run();

 private:
  Done follow();
  Done bind();
  Done write_plot() const;
  void step();
  void send();
  void report_changes();
  void report_events();
  void say(const std::string& text) const;

  AxisGroup& group_;
  const LogicOptions& options_;
  std::vector<Rule> rules_;
  std::function<bool()> interrupted_;
  std::optional<LogicProgram> program_;  // empty until the layout has come
  LogicTrace trace_;
  std::vector<double> reported_;  // values of the targets
  std::int64_t cycle_ = 0;        // cycle of the newest image
  Time time_{0};                  // time of the bus since the first image
};

}  // namespace takt
