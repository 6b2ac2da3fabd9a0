#include "apps/takt/simulate/motion/motion_programs.hpp"

#include <algorithm>
#include <iterator>
#include <set>
#include <span>
#include <utility>

#include "eds_parser/table/motion_axes.hpp"

namespace takt {
namespace {

std::string name_of(const BusPlan& plan, const MotionAxis& axis) {
  const std::string& node = plan.nodes[axis.node_index].name;
  return axis.number == 0 ? node : node + "." + std::to_string(axis.number + 1);
}

/// Makes the maxima of all axes that programs can command, without a value.
std::vector<AxisMaxima> maxima_of(const BusPlan& plan) {
  std::vector<AxisMaxima> all;
  for (const MotionAxis& axis : motion_axes(plan)) {
    all.push_back({.axis = name_of(plan, axis),
                   .unit = plan.layout.signals[axis.target].unit,
                   .node_id = plan.nodes[axis.node_index].id.value(),
                   .number = static_cast<std::int8_t>(axis.number + 1)});
  }
  for (const SpeedAxisPlan& axis : plan.speed_axes) {
    const auto actual = axis.actual_speed;
    all.push_back({.axis = plan.nodes[axis.node_index].name,
                   .unit = axis.unit,
                   .node_id = plan.nodes[axis.node_index].id.value(),
                   .speed_word = SpeedWord{.signal = actual.value_or(axis.set_speed),
                                           .scale = actual ? axis.actual_scale : axis.set_scale}});
  }
  return all;
}

/// Makes the outcome of each entry, in the state before the entry begins.
std::vector<MotionOutcome> outcomes_of(const BusPlan& plan, const MotionScripts& scripts) {
  const std::vector<AxisMaxima> known = maxima_of(plan);
  std::vector<MotionOutcome> outcomes;
  for (const MotionScript& script : scripts) {
    std::vector<AxisMaxima> axes;
    for (const std::string& wanted : script.axes) {
      axes.push_back(*std::ranges::find(known, wanted, &AxisMaxima::axis));
    }
    for (const MotionEntry& entry : script.entries) {
      const std::string usual = is_endless(entry.kind) ? "ended" : "done";
      outcomes.push_back({.program = script.program,
                          .kind = entry.kind,
                          .pos = entry.pos,
                          .axes = axes,
                          .expect = entry.expect.empty() ? usual : entry.expect});
    }
  }
  return outcomes;
}

}  // namespace

bool commands_node(const MotionScripts& scripts, std::string_view node) {
  const auto is_of_node = [&](std::string_view axis) {
    return axis.substr(0, axis.find('.')) == node;
  };
  return std::ranges::any_of(scripts, [&](const MotionScript& script) {
    return std::ranges::any_of(script.axes, is_of_node);
  });
}

std::size_t moved_axes(const std::vector<MotionOutcome>& outcomes) {
  std::set<std::string_view> moved;
  for (const MotionOutcome& outcome : outcomes) {
    for (const AxisMaxima& axis : outcome.axes) {
      if (axis.velocity > 0.0) moved.insert(axis.axis);
    }
  }
  return moved.size();
}

std::size_t unexpected_ends(const std::vector<MotionOutcome>& outcomes) {
  const auto unexpected = std::ranges::count(outcomes, false, &MotionOutcome::as_expected);
  return static_cast<std::size_t>(unexpected);
}

std::vector<std::string> motion_axis_names(const BusPlan& plan) {
  std::vector<std::string> names;
  for (const MotionAxis& axis : motion_axes(plan)) names.push_back(name_of(plan, axis));
  return names;
}

std::vector<std::string> speed_axis_names(const BusPlan& plan) {
  std::vector<std::string> names;
  for (const SpeedAxisPlan& axis : plan.speed_axes) {
    names.push_back(plan.nodes[axis.node_index].name);
  }
  return names;
}

MotionPrograms::MotionPrograms(const BusPlan& plan, const MotionScripts& scripts, VirtualLcm& lcm,
                               const Clocks& clocks, sim::Random random, Time end_of_run)
    : plan_{plan},
      end_of_run_{end_of_run},
      outcomes_{outcomes_of(plan, scripts)},
      observer_{lcm, plan.name, outcomes_} {
  std::size_t first = 0;
  for (const MotionScript& script : scripts) {
    programs_.push_back(
        {.script = script,
         .first_outcome = first,
         .process = std::make_unique<VirtualProcess>(lcm, clocks, random.fork(programs_.size()))});
    first += script.entries.size();
  }
  for (Program& program : programs_) {
    start(program);
    for (const MotionEntry& entry : program.script.entries) {
      if (entry.kind != MotionKind::kill || !entry.at) continue;
      killer_.agenda.add(*entry.at, [this, &program, at = *entry.at] { kill(program, at); });
    }
  }
}

void MotionPrograms::join(Stage& stage) {
  stage.add(killer_);
  for (const Program& program : programs_) stage.add(*program.process);
  stage.add(observer_);
}

/// The new process executes the entries up to the next `kill`.
void MotionPrograms::start(Program& program) {
  const std::vector<MotionEntry>& entries = program.script.entries;
  const auto begin = entries.begin() + static_cast<std::ptrdiff_t>(program.next);
  const auto end = std::find_if(
      begin, entries.end(), [](const MotionEntry& one) { return one.kind == MotionKind::kill; });
  const std::size_t first = program.first_outcome + program.next;
  const auto count = static_cast<std::size_t>(end - begin);
  VirtualProcess& process = *program.process;
  program.code = std::make_unique<MotionProgram>(
      MotionProgram::Setting{.bus = plan_.name,
                             .end_of_run = end_of_run_,
                             .connect = [&process] { return process.connect(); },
                             .is_killed = [&process] { return process.is_killed(); }},
      program.script, std::span{begin, count}, std::span{outcomes_}.subspan(first, count));
  program.next += count;
  process.start([&code = *program.code] { code.run(); });
}

/// `program.next` is the entry that kills the process.
void MotionPrograms::kill(Program& program, Time now) {
  program.process->kill();
  const auto outcomes = std::span{outcomes_}.subspan(program.first_outcome, program.next + 1);
  for (MotionOutcome& outcome : outcomes) {
    if (!outcome.begin) {
      outcome.text = "the program was killed before this entry began";
    } else if (!outcome.end) {
      outcome.end = now;
      outcome.result = "killed";
      outcome.text = "the program was killed during this entry";
      outcome.by_script = true;
    }
  }
  outcomes.back().begin = outcomes.back().end = now;
  outcomes.back().result = "done";
  outcomes.back().text.clear();
  outcomes.back().by_script = false;
  ++program.next;
  start(program);
}

std::vector<MotionOutcome> MotionPrograms::end() {
  for (Program& program : programs_) program.process->kill();
  for (MotionOutcome& outcome : outcomes_) outcome.by_script |= outcome.begin && !outcome.end;
  std::ranges::sort(outcomes_, {}, [](const MotionOutcome& one) { return one.pos.line; });
  return std::move(outcomes_);
}

}  // namespace takt
