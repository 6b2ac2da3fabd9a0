#pragma once
#include <cstddef>
#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "eds_parser/table/pdo_table.hpp"
#include "eds_parser/values/data_type.hpp"
#include "eds_parser/values/ids.hpp"

namespace takt {

/// The reaction of the master when the command of an output has exceeded its time to live.
enum class Fallback : std::uint8_t {
  hold,   ///< keep the last commanded value
  value,  ///< send Signal::fallback_value (zero, a safe value, the quick stop controlword)
};

/// The key of `on_timeout` that sets the time to live of commands. The default counts as `after`.
enum class TimeToLiveKey : std::uint8_t { after, after_cycles };

/// One value of the process image: its place, its meaning and its unit.
struct Signal {
  std::string name{};  ///< EDS name in snake_case, unique in its node: "position_actual_value"
  NodeId node;
  std::uint8_t node_index = 0;  ///< position in BusPlan::nodes
  ObjectKey object;
  DataType type = DataType::unknown;
  std::uint8_t bits = 0;
  bool output = false;    ///< true: mapped into an RPDO, so that the master sends it
  std::uint16_t row = 0;  ///< row of the PDO in PdoTable::tpdos or ::rpdos

  double scale = 1.0;  ///< SI value = raw * scale + offset
  double offset = 0.0;
  std::string unit{};  ///< "rad", "rad/s"; empty = raw count

  // outputs only
  Fallback fallback = Fallback::hold;
  std::int64_t fallback_value = 0;
  std::uint32_t fallback_cycles = 0;  ///< time to live of a command in cycles; 0 = no limit
  TimeToLiveKey fallback_key = TimeToLiveKey::after;
  std::optional<std::int64_t> safe_value{};  ///< value to send before the first command
  std::optional<SignalIndex>
      seeded_from{};  ///< input that provides the first value (6064 for 607A)
};

/// Shortest time to live of commands that a network file can configure.
inline constexpr std::uint32_t fewest_fallback_cycles = 3;

/// Order and meaning of all values of a bus. Inputs come first, then outputs. Each group is sorted
/// by object and then by node, so that the same object of all axes is one contiguous column.
struct ImageLayout {
  std::vector<Signal> signals;
  std::size_t inputs = 0;  ///< signals [0, inputs) are inputs, the rest outputs
  std::uint64_t hash = 0;  ///< covers names, objects, types, units and order; image_t repeats it

  std::size_t outputs() const noexcept { return signals.size() - inputs; }
  /// Returns std::nullopt if no PDO of the node carries the object in this direction.
  std::optional<SignalIndex> find(std::size_t node_index, ObjectKey object,
                                  bool output) const noexcept {
    for (std::size_t i = 0; i < signals.size(); ++i) {
      const Signal& signal = signals[i];
      if (signal.node_index == node_index && signal.object == object && signal.output == output) {
        return static_cast<SignalIndex>(i);
      }
    }
    return std::nullopt;
  }
};

}  // namespace takt
