#include <algorithm>
#include <array>
#include <charconv>
#include <cmath>
#include <map>
#include <optional>
#include <string_view>
#include <utility>

#include "apps/logic/logic_program.hpp"
#include "eds_parser/report/report.hpp"
#include "eds_parser/report/suggest.hpp"

namespace takt {
namespace {

/// States of a drive in its statusword (0x6041). CiA 402-2, table of the state machine.
struct DriveBits {
  std::string_view name;
  std::int64_t mask;
  std::int64_t pattern;
};
constexpr std::array<DriveBits, 2> drive_states{{{"fault", 0x4F, 0x08}, {"enabled", 0x6F, 0x27}}};
constexpr std::int32_t statusword = 0x6041;

}  // namespace

/// Binds the names in the rules to the signals of one bus.
class LogicProgram::Binder {
 public:
  Binder(LogicProgram& program, const std::vector<signal_t>& signals,
         std::span<const std::int16_t> axes, const std::string& file)
      : program_{program}, signals_{signals}, axes_{axes}, report_{file} {
    for (const signal_t& signal : signals_) full_names_.push_back(signal.node + "." + signal.name);
  }

  Findings bind() {
    program_.states_.resize(program_.rules_.size());
    for (std::size_t i = 0; i < program_.rules_.size(); ++i) {
      const Rule& rule = program_.rules_[i];
      State& state = program_.states_[i];
      state.first = bound(rule.first);
      if (rule.second) state.second = bound(*rule.second);
      if (rule.target.contains('.')) bind_target(rule, state.target);
    }
    set_others_to_zero();
    return report_.take();
  }

 private:
  /// A signal, and the bit of it that the name asks for.
  struct Found {
    std::size_t signal = 0;
    std::optional<unsigned> bit;
  };

  std::optional<Found> find(std::string_view name) const {
    const auto whole = std::ranges::find(full_names_, name);
    if (whole != full_names_.end()) {
      return Found{.signal = static_cast<std::size_t>(whole - full_names_.begin()), .bit = {}};
    }
    const std::size_t point = name.rfind('.');
    if (point == std::string_view::npos) return std::nullopt;
    unsigned bit = 0;
    const char* end = name.data() + name.size();
    const auto read = std::from_chars(name.data() + point + 1, end, bit);
    if (read.ec != std::errc{} || read.ptr != end) return std::nullopt;
    auto found = find(name.substr(0, point));
    if (!found || found->bit) return std::nullopt;
    if (bit >= static_cast<unsigned>(signals_[found->signal].bits)) return std::nullopt;
    found->bit = bit;
    return found;
  }

  std::optional<Source> drive_state(std::string_view name) const {
    for (const DriveBits& state : drive_states) {
      if (!name.ends_with(state.name)) continue;
      for (std::size_t i = 0; i < signals_.size(); ++i) {
        if (signals_[i].index != statusword) continue;
        if (signals_[i].node + "." + std::string{state.name} != name) continue;
        return Source{
            .kind = Kind::drive_state, .place = i, .mask = state.mask, .pattern = state.pattern};
      }
    }
    return std::nullopt;
  }

  /// Returns the source of a name. The target of a rule has the value that the rule has set, even
  /// before the bus has taken it.
  std::optional<Source> source(std::string_view name) const {
    for (std::size_t i = 0; i < program_.rules_.size(); ++i) {
      if (program_.rules_[i].target == name) return Source{.kind = Kind::target, .place = i};
    }
    if (const auto found = find(name)) {
      const signal_t& signal = signals_[found->signal];
      return Source{.kind = found->bit ? Kind::bit : Kind::signal,
                    .place = found->signal,
                    .bit = found->bit.value_or(0),
                    .scale = signal.unit.empty() ? 1.0 : signal.scale,
                    .offset = signal.unit.empty() ? 0.0 : signal.offset};
    }
    return drive_state(name);
  }

  Bound bound(const WrittenExpression& written) {
    Bound bound;
    for (const Step& step : written.expression.steps) {
      if (const double* number = std::get_if<double>(&step)) {
        bound.steps.emplace_back(*number);
      } else if (const NameUse* use = std::get_if<NameUse>(&step)) {
        bind_name(bound, written.pos_of(*use), use->name);
      } else {
        const Operation operation = std::get<Operation>(step);
        bound.steps.emplace_back(operation);
        const bool is_edge = operation == Operation::rising || operation == Operation::falling;
        if (is_edge) bound.before.push_back(0);
      }
    }
    return bound;
  }

  void bind_name(Bound& bound, SourcePos pos, const std::string& name) {
    const auto known = std::ranges::find(program_.source_names_, name);
    const auto place = static_cast<std::size_t>(known - program_.source_names_.begin());
    if (known == program_.source_names_.end()) {
      const auto found = source(name);
      if (!found) {
        report_.error(pos, "unknown-name", "the bus has no signal `", name,
                      "`, and no rule sets it", guess(name));
        bound.steps.emplace_back(0.0);
        return;
      }
      program_.sources_.push_back(*found);
      program_.source_names_.push_back(name);
    }
    bound.steps.emplace_back(place);
    const Source& used = program_.sources_[place];
    if (used.kind != Kind::target) bound.signals.push_back(used.place);
  }

  std::string guess(const std::string& name) const {
    std::vector<std::string_view> names{full_names_.begin(), full_names_.end()};
    for (const Rule& rule : program_.rules_) {
      if (!rule.target.contains('.')) names.emplace_back(rule.target);
    }
    return did_you_mean(name, names);
  }

  void bind_target(const Rule& rule, Target& target) {
    const auto found = find(rule.target);
    if (!found) {
      report_.error(rule.pos, "unknown-name", "the bus has no output `", rule.target, "`",
                    guess(rule.target));
      return;
    }
    const signal_t& signal = signals_[found->signal];
    if (!signal.output) {
      report_.error(rule.pos, "target", "`", rule.target, "` is an input: rules set outputs");
      return;
    }
    if (std::ranges::find(axes_, signal.node_id) != axes_.end()) {
      report_.error(rule.pos, "target", "`", signal.node,
                    "` is an axis: takt-logic sets the outputs of I/O nodes");
      return;
    }
    const auto use = whole_.emplace(found->signal, !found->bit).first;
    if (use->second != !found->bit) {
      report_.error(rule.pos, "target", "other rules set ", found->bit ? "all" : "single bits",
                    " of this output: set either the whole output or single bits of it");
      return;
    }
    target.is_marker = false;
    target.output = output_of(found->signal);
    if (found->bit) {
      target.bit = static_cast<int>(*found->bit);
      if (rule.on_value == 1.0 && rule.off_value == 0.0) return;
      report_.error(rule.pos, "value", "`", rule.target, "` is a bit, which has no `value`");
      return;
    }
    target.on = raw_value(rule, signal, rule.on_value);
    target.off = rule.off_value == 0.0 ? 0 : raw_value(rule, signal, rule.off_value);
  }

  void set_others_to_zero() {
    const std::vector<Output> set = program_.outputs_;
    for (std::size_t i = 0; i < signals_.size(); ++i) {
      const bool is_same_node = std::ranges::any_of(set, [&](const Output& output) {
        return signals_[output.signal].node_id == signals_[i].node_id;
      });
      if (signals_[i].output && is_same_node) output_of(i);
    }
  }

  /// Returns the place of this output in outputs_.
  std::size_t output_of(std::size_t signal) {
    auto& outputs = program_.outputs_;
    const auto known = std::ranges::find(outputs, signal, &Output::signal);
    if (known != outputs.end()) return static_cast<std::size_t>(known - outputs.begin());
    outputs.push_back({.signal = signal, .raw = 0});
    return outputs.size() - 1;
  }

  std::int64_t raw_value(const Rule& rule, const signal_t& signal, double value) {
    const bool scaled = !signal.unit.empty() && signal.scale != 0.0;
    const double raw = std::round(scaled ? (value - signal.offset) / signal.scale : value);
    const double most = std::exp2(std::min<int>(signal.bits, 62));
    if (std::abs(raw) < most) return static_cast<std::int64_t>(raw);
    report_.error(rule.pos, "value", "the value does not fit the ",
                  std::to_string(int{signal.bits}), " bits of `", rule.target, "`");
    return 0;
  }

  LogicProgram& program_;
  const std::vector<signal_t>& signals_;
  std::span<const std::int16_t> axes_;
  Report report_;
  std::vector<std::string> full_names_;
  std::map<std::size_t, bool> whole_;  // outputs that rules set: as a whole, or single bits
};

void LogicProgram::bind(const std::vector<signal_t>& signals, std::span<const std::int16_t> axes,
                        const std::string& file, Findings& findings) {
  for (Finding& finding : Binder{*this, signals, axes, file}.bind()) {
    findings.push_back(std::move(finding));
  }
}

}  // namespace takt
