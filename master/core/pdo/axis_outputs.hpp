#pragma once
#include <optional>

#include "eds_parser/table/image_layout.hpp"

namespace takt {

/// Outputs of the same axis as a position target.
struct AxisOutputs {
  std::optional<SignalIndex> controlword{};  ///< 0x6040
  std::optional<SignalIndex> offset{};       ///< 0x60B0, which drives add to the position target
};

/// Returns the outputs that belong to `target`. Both are empty if `target` is not a position target
/// (0x607A or 0x60C1:01, or the same object of another axis of the device).
AxisOutputs axis_outputs(const ImageLayout& layout, SignalIndex target);

}  // namespace takt
