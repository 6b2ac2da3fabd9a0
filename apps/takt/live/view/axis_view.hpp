#pragma once
#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "apps/takt/live/text/line.hpp"
#include "apps/takt/live/text/quantity.hpp"
#include "master/gateway/message/bus_view.hpp"

namespace takt {

/// A word of a drive and its meaning.
struct DriveWord {
  std::uint16_t value = 0;
  std::string text;
};

/// The values that are shown for one axis.
struct AxisView {
  std::string name;
  std::int16_t node = 0;
  PaintedText state;  ///< state of the drive, or of the node while the node has not booted
  std::string mode;
  ShownQuantity position;
  ShownQuantity velocity;
  ShownQuantity following_error;
  PaintedText error;  ///< "-", or the code and its meaning
  std::optional<DriveWord> statusword;
  std::optional<DriveWord> controlword;
};

/// Returns the axes of a bus with positions, then its speed axes, each by its node-ID. The list is
/// empty until the layout and the first image have come.
std::vector<AxisView> axes_of(const BusView& bus);

/// Returns the nodes that have no axis.
std::vector<const node_status_t*> other_nodes(const BusView& bus,
                                              const std::vector<AxisView>& axes);

}  // namespace takt
