#include "eds_parser/table/limit_names.hpp"

namespace takt {

std::string_view name(LimitKind kind) noexcept {
  switch (kind) {
    case LimitKind::position:
      return "position";
    case LimitKind::velocity:
      return "velocity";
    case LimitKind::acceleration:
      return "acceleration";
    case LimitKind::jerk:
      return "jerk";
    case LimitKind::step:
      return "step";
    case LimitKind::torque:
      return "torque";
    case LimitKind::range:
      return "range";
  }
  return "limit";
}

std::string_view name(LimitSource source) noexcept {
  switch (source) {
    case LimitSource::none:
      return "none";
    case LimitSource::file:
      return "file";
    case LimitSource::device:
      return "device";
  }
  return "none";
}

}  // namespace takt
