#pragma once
#include <array>
#include <cstddef>
#include <cstdint>
#include <span>

#include "eds_parser/table/boot_plan.hpp"
#include "eds_parser/table/bus_plan.hpp"
#include "master/core/node_status.hpp"

namespace takt {

/// The object dictionary of the master itself, so that tools can read it: made from the plan and
/// the state of the nodes, nothing is stored. CiA 301, 7.5 and CiA 302-2, 4.5.
///
/// Only 0x1F82 (request NMT) can be written.
class OwnDictionary {
 public:
  /// `statuses` in the order of plan.nodes; both outlive the dictionary.
  OwnDictionary(const BusPlan& plan, std::span<const NodeStatus> statuses) noexcept;

  /// Longest value, in bytes.
  static constexpr std::size_t longest = 64;
  struct Value {
    std::uint32_t abort_code = 0;  ///< 0: `size` bytes of `bytes` are the value
    std::uint8_t size = 0;
    std::array<std::byte, longest> bytes{};

    std::span<const std::byte> data() const noexcept { return std::span{bytes}.first(size); }
  };
  Value read(ObjectKey key) const noexcept;

  /// What writing an object asks for. Node 0: all.
  struct Order {
    std::uint32_t abort_code = 0;  ///< 0: `command` is to be sent
    NmtCommand command = NmtCommand::start;
    std::uint8_t node = 0;
  };
  Order write(ObjectKey key, std::span<const std::byte> value) const noexcept;

 private:
  static constexpr std::uint8_t no_node = 0xFF;

  Value read_communication(ObjectKey key) const noexcept;
  Value read_consumers(std::uint8_t sub) const noexcept;
  Value read_nodes(ObjectKey key) const noexcept;
  std::uint32_t node_value(std::uint16_t index, std::size_t node) const noexcept;

  const BusPlan& plan_;
  std::span<const NodeStatus> statuses_;
  std::array<std::uint8_t, 128> position_;  // node id -> plan.nodes
};

}  // namespace takt
