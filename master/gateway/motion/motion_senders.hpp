#pragma once
#include <algorithm>
#include <array>
#include <cstddef>
#include <cstdint>
#include <optional>

#include "eds_parser/values/time.hpp"
#include "master/motion/beat/motion_order.hpp"

namespace takt {

/// Gives the senders of motions numbers for the bus thread. A number is given to another sender
/// only when its previous sender has been silent for so long that all of its motions have ended.
/// All calls come from the front thread.
class MotionSenders {
 public:
  /// Longest timeout of a motion. See motion_command_t::timeout_ms.
  static constexpr Time longest_timeout = std::chrono::seconds{10};

  /// Returns the number of the sender with this instance, or std::nullopt if all numbers are taken.
  std::optional<std::uint8_t> number_of(std::int64_t instance, Time now) {
    auto found = std::ranges::find(slots_, instance, &Slot::instance);
    if (found == slots_.end()) {
      found = std::ranges::find_if(slots_, [&](const Slot& slot) {
        return slot.instance == 0 || now - slot.heard > 2 * longest_timeout;
      });
    }
    if (found == slots_.end()) return std::nullopt;
    *found = {.instance = instance, .heard = now};
    return static_cast<std::uint8_t>(found - slots_.begin());
  }

 private:
  struct Slot {
    std::int64_t instance = 0;  ///< 0 means that the number is free
    Time heard{};
  };
  std::array<Slot, motion::max_axes> slots_{};
};

}  // namespace takt
