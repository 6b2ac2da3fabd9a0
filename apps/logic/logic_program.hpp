#pragma once
#include <cstddef>
#include <cstdint>
#include <span>
#include <string>
#include <takt/image_input.hpp>
#include <takt/signal_t.hpp>
#include <variant>
#include <vector>

#include "apps/logic/rules.hpp"

namespace takt {

/// Rules that are bound to the layout of a bus. step() evaluates all of them once, in the order of
/// the file. A rule sees the markers of earlier rules as they are now, and the markers of later
/// rules as they were after the previous image. Rules may therefore refer to each other.
///
/// A rule that reads an input whose PDO is missing is off, and its delays begin anew.
class LogicProgram {
 public:
  /// A value of an output, raw, and the place of the output in the layout.
  struct Output {
    std::size_t signal = 0;
    std::int64_t raw = 0;
  };

  /// Binds the rules. Appends to `findings` what does not fit the layout: unknown names, targets
  /// that are inputs, outputs of axes (of nodes in `axes`), and values that do not fit their
  /// output.
  LogicProgram(std::vector<Rule> rules, const std::vector<signal_t>& signals,
               std::span<const std::int16_t> axes, const std::string& file, Findings& findings);

  /// Evaluates all rules with this image. `passed` is the time since the image before.
  void step(const ImageInput& input, Time passed);

  /// Returns the values of all outputs of each node that has at least one rule. Outputs without a
  /// rule are 0, because the device gets an RPDO only if each output in it has a value.
  const std::vector<Output>& outputs() const noexcept { return outputs_; }
  /// Returns the names of all inputs that rules read, and of all targets.
  std::vector<std::string> names() const;
  /// Returns the values of these names with the image of the newest step().
  std::vector<double> values(const ImageInput& input) const;
  /// Returns the value of the target of a rule. For a marker or counter it is the number; for an
  /// output it is 1 while the output is on, else 0.
  double value(std::size_t rule) const { return states_[rule].value; }

 private:
  enum class Kind : std::uint8_t { signal, bit, drive_state, target };
  /// The source of the value of a name.
  struct Source {
    Kind kind = Kind::target;
    std::size_t place = 0;  // position of the signal, or of the rule
    unsigned bit = 0;
    std::int64_t mask = 0;  // mask of a drive state in the statusword
    std::int64_t pattern = 0;
    double scale = 1.0;
    double offset = 0.0;
  };
  using Code = std::variant<double, std::size_t, Operation>;  // std::size_t: position in sources_
  struct Bound {
    std::vector<Code> steps;
    std::vector<std::size_t> signals;  // signals that the program reads
    std::vector<char> before;          // operands of the edges at the previous image
  };
  struct Target {
    std::size_t output = 0;  // position in outputs_
    int bit = -1;            // -1: the whole output
    std::int64_t on = 1;     // raw
    std::int64_t off = 0;
    bool is_marker = true;
  };
  struct State {
    Bound first;
    Bound second;
    Target target;
    double value = 0.0;
    bool was = false;  // value of `first` at the previous image
    Time since{0};     // time for which `first` differs from the target
  };

  class Binder;

  void bind(const std::vector<signal_t>& signals, std::span<const std::int16_t> axes,
            const std::string& file, Findings& findings);
  double evaluate(Bound& bound, const ImageInput& input);
  double read(const Source& source, const ImageInput& input) const;
  static bool stale(const Bound& bound, const ImageInput& input);
  void run(std::size_t rule, const ImageInput& input, Time passed);
  void write(const State& state);

  std::vector<Rule> rules_;
  std::vector<State> states_;
  std::vector<Source> sources_;
  std::vector<std::string> source_names_;
  std::vector<Output> outputs_;
  std::vector<double> stack_;
};

}  // namespace takt
