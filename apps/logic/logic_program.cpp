#include "apps/logic/logic_program.hpp"

#include <algorithm>
#include <cmath>
#include <utility>

namespace takt {

LogicProgram::LogicProgram(std::vector<Rule> rules, const std::vector<signal_t>& signals,
                           std::span<const std::int16_t> axes, const std::string& file,
                           Findings& findings)
    : rules_{std::move(rules)} {
  bind(signals, axes, file, findings);
}

double LogicProgram::read(const Source& source, const ImageInput& input) const {
  if (source.kind == Kind::target) {
    const Rule& rule = rules_[source.place];
    const double value = states_[source.place].value;
    if (rule.kind == RuleKind::count) return value;
    return value != 0.0 ? rule.on_value : rule.off_value;
  }
  const std::int64_t raw = input.values()[source.place];
  switch (source.kind) {
    case Kind::bit:
      return static_cast<double>(raw >> source.bit & 1);
    case Kind::drive_state:
      return (raw & source.mask) == source.pattern ? 1.0 : 0.0;
    default:
      return static_cast<double>(raw) * source.scale + source.offset;
  }
}

double LogicProgram::evaluate(Bound& bound, const ImageInput& input) {
  std::size_t edges = 0;
  stack_.clear();
  const auto pop = [this] {
    const double top = stack_.back();
    stack_.pop_back();
    return top;
  };
  for (const Code& step : bound.steps) {
    if (const double* number = std::get_if<double>(&step)) {
      stack_.push_back(*number);
      continue;
    }
    if (const std::size_t* source = std::get_if<std::size_t>(&step)) {
      stack_.push_back(read(sources_[*source], input));
      continue;
    }
    const Operation operation = std::get<Operation>(step);
    const double right = pop();
    const bool on = right != 0.0;
    bool result = false;
    if (operation == Operation::negate) {
      result = !on;
    } else if (operation == Operation::rising || operation == Operation::falling) {
      const bool was = std::exchange(bound.before[edges++], on ? 1 : 0) != 0;
      result = was != on && on == (operation == Operation::rising);
    } else {
      const double left = pop();
      switch (operation) {
        case Operation::both:
          result = left != 0.0 && on;
          break;
        case Operation::either:
          result = left != 0.0 || on;
          break;
        case Operation::equal:
          result = left == right;
          break;
        case Operation::unequal:
          result = left != right;
          break;
        case Operation::less:
          result = left < right;
          break;
        case Operation::at_most:
          result = left <= right;
          break;
        case Operation::greater:
          result = left > right;
          break;
        default:
          result = left >= right;
          break;
      }
    }
    stack_.push_back(result ? 1.0 : 0.0);
  }
  return stack_.empty() ? 0.0 : pop();
}

bool LogicProgram::stale(const Bound& bound, const ImageInput& input) {
  return std::ranges::any_of(bound.signals, [&](std::size_t i) { return input.stale(i); });
}

void LogicProgram::run(std::size_t rule, const ImageInput& input, Time passed) {
  State& state = states_[rule];
  const Rule& made = rules_[rule];
  const bool first = evaluate(state.first, input) != 0.0;
  const bool second = evaluate(state.second, input) != 0.0;
  const bool blind = stale(state.first, input) || stale(state.second, input);
  const bool was = std::exchange(state.was, first);
  if (made.kind == RuleKind::count) {
    if (second && !blind) {
      state.value = 0.0;
    } else if (first && !was && !blind) {
      state.value += 1.0;
    }
    return;
  }
  const bool is_on = state.value != 0.0;
  if (blind) {
    state.value = 0.0;
    state.since = Time{0};
  } else if (made.kind == RuleKind::latch) {
    state.value = !second && (first || is_on) ? 1.0 : 0.0;
  } else if (first == is_on) {
    state.since = Time{0};
  } else {
    const Time delay = first ? made.on_delay : made.off_delay;
    if (was == first) state.since += passed;
    if (state.since >= delay) {
      state.value = first ? 1.0 : 0.0;
      state.since = Time{0};
    }
  }
}

void LogicProgram::write(const State& state) {
  if (state.target.is_marker) return;
  std::int64_t& raw = outputs_[state.target.output].raw;
  const bool on = state.value != 0.0;
  if (state.target.bit < 0) {
    raw = on ? state.target.on : state.target.off;
  } else if (on) {
    raw |= std::int64_t{1} << state.target.bit;
  }
}

std::vector<std::string> LogicProgram::names() const {
  std::vector<std::string> names;
  for (std::size_t i = 0; i < sources_.size(); ++i) {
    if (sources_[i].kind != Kind::target) names.push_back(source_names_[i]);
  }
  for (const Rule& rule : rules_) names.push_back(rule.target);
  return names;
}

std::vector<double> LogicProgram::values(const ImageInput& input) const {
  std::vector<double> values;
  for (const Source& source : sources_) {
    if (source.kind != Kind::target) values.push_back(read(source, input));
  }
  for (std::size_t i = 0; i < rules_.size(); ++i) {
    values.push_back(read({.kind = Kind::target, .place = i}, input));
  }
  return values;
}

void LogicProgram::step(const ImageInput& input, Time passed) {
  for (Output& output : outputs_) output.raw = 0;
  for (std::size_t i = 0; i < rules_.size(); ++i) {
    run(i, input, passed);
    write(states_[i]);
  }
}

}  // namespace takt
