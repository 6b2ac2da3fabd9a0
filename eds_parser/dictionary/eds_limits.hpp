#pragma once
#include <optional>
#include <variant>

#include "eds_parser/dictionary/object_dictionary.hpp"

namespace takt {

/// Returns true if `value` is below the low limit or above the high limit. Texts have no order and
/// are never outside.
inline bool outside_limits(const Value& value, const SubObject& sub) noexcept {
  const auto comparable = [&value](const std::optional<Value>& limit) {
    return limit && limit->index() == value.index() && !std::holds_alternative<BoxedText>(value);
  };
  if (comparable(sub.low_limit) && value < *sub.low_limit) return true;
  return comparable(sub.high_limit) && value > *sub.high_limit;
}

}  // namespace takt
