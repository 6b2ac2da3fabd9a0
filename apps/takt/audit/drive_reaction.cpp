#include <algorithm>
#include <array>
#include <fmt/format.h>

#include "apps/takt/audit/reaction.hpp"

namespace takt {
namespace {

constexpr unsigned axes = 8;
constexpr unsigned next_axis = 0x800;

std::string braked(std::optional<int> code, std::string_view object) {
  if (!code) return "";
  constexpr std::array<const char*, 5> ways{", coasts", ", along the slow-down ramp",
                                            ", along the quick-stop ramp", ", at the current limit",
                                            ", at the voltage limit"};
  const int way = *code >= 5 && *code <= 8 && object == "605A" ? *code - 4 : *code;
  const bool known = way >= 0 && way < std::ssize(ways);
  return fmt::format("{} ({} = {})",
                     known ? ways[static_cast<std::size_t>(way)] : ", as the manufacturer defines",
                     object, *code);
}

class Axis {
 public:
  Axis(const DeviceValues& values, unsigned number)
      : values_{values}, number_{number}, code_{values.option(at(0x6007))} {}

  Reaction reaction() const {
    if (!code_)
      return {Failsafe::unspecified, "the drive has no " + name(0x6007) + ": see the manual"};
    const std::string tail = " (" + name(0x6007) + " = " + std::to_string(*code_) + ")";
    switch (*code_) {
      case 0:
        return with_remedy({Failsafe::goes_on, "does nothing: KEEPS its last set-point" + tail});
      case 1:
        return {Failsafe::stops, "fault" + tail + braked(values_.option(at(0x605E)), "605E")};
      case 2:
        return {Failsafe::stops, "loses its torque and coasts" + tail};
      case 3:
        return {Failsafe::stops, "quick stop" + tail + braked(values_.option(at(0x605A)), "605A")};
      default:
        return with_remedy({Failsafe::unspecified, "as the manufacturer defines" + tail});
    }
  }

 private:
  std::uint16_t at(unsigned index) const {
    return static_cast<std::uint16_t>(index + next_axis * number_);
  }
  std::string name(unsigned index) const { return hex(at(index)).substr(2); }

  /// Adds the first reaction that the drive accepts: quick stop (3), fault (1), or no torque (2).
  Reaction with_remedy(Reaction reaction) const {
    const ObjectKey code{at(0x6007), 0};
    for (const int value : {3, 1, 2}) {
      if (!values_.takes(code, value)) continue;
      reaction.remedy.push_back(fmt::format("{{index: {}, value: {}}}", hex(code.index), value));
      return reaction;
    }
    reaction.fixed.push_back(code);
    return reaction;
  }

  const DeviceValues& values_;
  unsigned number_;
  std::optional<int> code_;
};

}  // namespace

Reaction drive_reaction(const DeviceValues& values) {
  std::vector<Reaction> found;
  for (unsigned n = 0; n < axes; ++n) {
    const auto controlword = static_cast<std::uint16_t>(0x6040 + next_axis * n);
    if (n == 0 || values.has(controlword)) found.push_back(Axis{values, n}.reaction());
  }
  Reaction all{.verdict = Failsafe::harmless};
  for (std::size_t n = 0; n < found.size(); ++n) {
    all.verdict = std::max(all.verdict, found[n].verdict);
    const bool same = n > 0 && found[n].text == found[0].text;
    if (!same) {
      all.text += (n > 0 ? "; axis " + std::to_string(n + 1) + ": " : "") + found[n].text;
    }
    all.remedy.insert(all.remedy.end(), found[n].remedy.begin(), found[n].remedy.end());
    all.fixed.insert(all.fixed.end(), found[n].fixed.begin(), found[n].fixed.end());
  }
  return all;
}

}  // namespace takt
