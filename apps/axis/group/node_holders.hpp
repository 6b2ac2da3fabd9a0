#pragma once
#include <array>
#include <cstdint>
#include <string>
#include <string_view>
#include <takt/axis.hpp>
#include <takt/status_t.hpp>

namespace takt {

/// Remembers which program holds each node.
class NodeHolders {
 public:
  /// `sender` is the name of this program in status_t. No other running program has the same name.
  explicit NodeHolders(std::string_view sender) : sender_{sender} {}

  void take(const status_t& part);
  /// Returns the holder of a node-ID. Before the first status_t, no program holds a node.
  const NodeHolder& operator[](std::int16_t node) const noexcept;
  /// Forgets all holders, because taktd has restarted.
  void clear();

 private:
  static constexpr std::int16_t highest_node = 127;
  std::string sender_;
  std::array<NodeHolder, highest_node + 1> nodes_;  // indexed by node-ID; 0 is unused
};

}  // namespace takt
