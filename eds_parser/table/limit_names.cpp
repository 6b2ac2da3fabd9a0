#include "eds_parser/table/limit_names.hpp"

#include "eds_parser/table/name_of.hpp"

namespace takt {

std::string_view name(LimitKind kind) noexcept {
  static constexpr std::string_view names[]{"position", "velocity", "acceleration", "jerk",
                                            "step",     "torque",   "range"};
  return name_of(kind, names, "limit");
}

std::string_view name(LimitSource source) noexcept {
  static constexpr std::string_view names[]{"none", "file", "device"};
  return name_of(source, names, "none");
}

}  // namespace takt
