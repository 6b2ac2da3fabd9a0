#pragma once
#include <array>
#include <concepts>
#include <cstddef>
#include <cstdint>
#include <span>

#include "eds_parser/table/boot_plan.hpp"
#include "eds_parser/table/bus_plan.hpp"
#include "master/core/node_status.hpp"
#include "master/wire/bytes.hpp"

namespace takt {

/// The object dictionary of the master itself, for tools that read it. All values follow from the
/// plan and the state of the nodes; nothing is stored. CiA 301, 7.5 and CiA 302-2, 4.5.
///
/// Only 0x1F82 (request NMT) can be written.
class OwnDictionary {
 public:
  /// `statuses` is in the order of plan.nodes. The plan and the statuses must outlive the
  /// dictionary.
  OwnDictionary(const BusPlan& plan, std::span<const NodeStatus> statuses) noexcept;

  /// Size of the longest value in bytes.
  static constexpr std::size_t longest = 64;
  /// Result of read().
  struct Value {
    std::uint32_t abort_code = 0;  ///< 0 means that the first `size` bytes of `bytes` are the value
    std::uint8_t size = 0;
    std::array<std::byte, longest> bytes{};

    std::span<const std::byte> data() const noexcept { return std::span{bytes}.first(size); }

    static Value refused(std::uint32_t abort_code) noexcept { return {.abort_code = abort_code}; }
    template <std::unsigned_integral T>
    static Value number(T value) noexcept {
      Value out{.size = sizeof(T)};
      store_le(std::span{out.bytes}, value);
      return out;
    }
  };
  /// Reads an object. The abort code of the result is not 0 if the object cannot be read.
  Value read(ObjectKey key) const noexcept;

  /// The NMT command that a write requests. Node 0 means all nodes.
  struct Order {
    std::uint32_t abort_code = 0;  ///< 0 means that `command` is to be sent
    NmtCommand command = NmtCommand::start;
    std::uint8_t node = 0;
  };
  /// Checks a write. The abort code of the result is not 0 if the object cannot be written.
  Order write(ObjectKey key, std::span<const std::byte> value) const noexcept;

 private:
  static constexpr std::uint8_t no_node = 0xFF;

  /// Returns true if the object has one sub-index for each node.
  static bool is_of_nodes(std::uint16_t index) noexcept;
  Value read_communication(ObjectKey key) const noexcept;
  Value read_variable(std::uint16_t index) const noexcept;
  Value read_consumers(std::uint8_t sub) const noexcept;
  Value read_nodes(ObjectKey key) const noexcept;

  const BusPlan& plan_;
  std::span<const NodeStatus> statuses_;
  std::array<std::uint8_t, 128> position_;  // node-ID -> index into plan.nodes
};

}  // namespace takt
