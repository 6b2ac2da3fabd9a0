#include <algorithm>
#include <array>
#include <fmt/format.h>
#include <set>
#include <utility>

#include "apps/takt/audit/reaction.hpp"

namespace takt {
namespace {

/// Outputs of one width, with the objects of their error mode and error value.
struct OutputKind {
  std::uint16_t outputs;
  std::uint16_t mode;
  std::uint16_t value;
  bool mask;  ///< true: the error mode is a bit mask; false: error mode 1 applies the error value
  std::uint64_t all;
};

constexpr std::array<OutputKind, 8> kinds{{{0x6200, 0x6206, 0x6207, true, 0xFF},
                                           {0x6220, 0x6226, 0x6227, false, 1},
                                           {0x6300, 0x6306, 0x6307, true, 0xFFFF},
                                           {0x6320, 0x6326, 0x6327, true, 0xFFFF'FFFF},
                                           {0x6410, 0x6443, 0x6444, false, 1},
                                           {0x6411, 0x6443, 0x6444, false, 1},
                                           {0x6412, 0x6443, 0x6444, false, 1},
                                           {0x6413, 0x6443, 0x6445, false, 1}}};

/// Reaction of one output. Neighbours with the same reaction are reported together.
struct OutputResult {
  ObjectKey first;
  std::uint8_t last = 0;
  Failsafe verdict = Failsafe::unspecified;
  std::string text{};
};

std::string number_text(const OutputKind& kind, std::uint64_t value) {
  return kind.mask ? hex(static_cast<std::uint32_t>(value), 2) : std::to_string(value);
}

class Outputs {
 public:
  explicit Outputs(const DeviceValues& values) : values_{values} {}

  void add(ObjectKey object) {
    const auto kind = std::ranges::find(kinds, object.index, &OutputKind::outputs);
    OutputResult output{.first = object, .last = object.sub};
    if (kind == kinds.end()) {
      output.text = "is specific to the manufacturer: see the manual";
    } else {
      judge(*kind, output);
    }
    verdict_ = std::max(verdict_, output.verdict);
    if (!outputs_.empty() && continues(outputs_.back(), output)) {
      outputs_.back().last = object.sub;
    } else {
      outputs_.push_back(std::move(output));
    }
  }

  Reaction take() {
    Reaction reaction{
        .verdict = verdict_, .text = {}, .remedy = std::move(remedy_), .fixed = std::move(fixed_)};
    for (const OutputResult& output : outputs_) {
      reaction.text += (reaction.text.empty() ? "" : "; ") + to_string(output.first);
      if (output.last != output.first.sub) reaction.text += ".." + hex(output.last, 2).substr(2);
      reaction.text += " " + output.text;
    }
    return reaction;
  }

 private:
  static bool continues(const OutputResult& before, const OutputResult& output) {
    return before.text == output.text && before.first.index == output.first.index &&
           before.last + 1 == output.first.sub;
  }

  void judge(const OutputKind& kind, OutputResult& output) {
    const ObjectKey mode_key{kind.mode, output.first.sub};
    const auto mode = values_.get(mode_key);
    const auto value = values_.get({kind.value, output.first.sub});
    if (!mode || !value) {
      output.text = "has no " + hex(mode ? kind.value : kind.mode).substr(2) + ": see the manual";
      return;
    }
    const std::uint64_t taken = *mode & kind.all;
    const std::string tail = fmt::format(" ({:04X} = {})", kind.mode, number_text(kind, *mode));
    if (taken == kind.all) {
      output.verdict = Failsafe::stops;
      output.text = "goes to " + number_text(kind, *value & (kind.mask ? kind.all : ~0ULL)) + tail;
      return;
    }
    output.verdict = Failsafe::goes_on;
    output.text = taken == 0 ? "STAYS" + tail
                             : "STAYS except for bits " + number_text(kind, taken) +
                                   ", which go to " + number_text(kind, *value & taken) + tail;
    if (!values_.takes(mode_key, static_cast<std::int64_t>(kind.all))) {
      fixed_.push_back(mode_key);
      return;
    }
    remedy_.push_back(fmt::format("{{index: {}, sub_index: {}, value: {}}}", hex(kind.mode),
                                  output.first.sub, number_text(kind, kind.all)));
  }

  const DeviceValues& values_;
  Failsafe verdict_ = Failsafe::harmless;
  std::vector<OutputResult> outputs_;
  std::vector<std::string> remedy_;
  std::vector<ObjectKey> fixed_;
};

}  // namespace

Reaction output_reaction(const BusPlan& plan, std::size_t node_index, const DeviceValues& values) {
  std::set<ObjectKey> commanded;
  for (const Signal& signal : plan.layout.signals) {
    if (signal.output && signal.node_index == node_index) commanded.insert(signal.object);
  }
  Outputs outputs{values};
  for (const ObjectKey& output : commanded) outputs.add(output);
  return outputs.take();
}

}  // namespace takt
