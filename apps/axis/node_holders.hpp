#pragma once
#include <array>
#include <cstdint>
#include <string>
#include <string_view>
#include <takt/status_t.hpp>

namespace takt {

/// The program that commands the outputs of a node, as the newest status_t shows it.
struct NodeHolder {
  std::string name;  ///< name of its sender; empty if nobody commands the outputs
  bool own = false;  ///< true if this is the program that asks
  int statuses = 0;  ///< number of status_t in sequence that show this holder; 10 in a second

  /// Returns true if at least the newest `sequence` status_t show the same other program.
  bool is_other(int sequence = 1) const noexcept {
    return !name.empty() && !own && statuses >= sequence;
  }
};

/// Remembers which program holds each node.
class NodeHolders {
 public:
  /// `sender` is the name of this program in status_t, which no other running program has.
  explicit NodeHolders(std::string_view sender) : sender_{sender} {}

  void take(const status_t& part);
  /// Returns the holder of a node-ID. Before the first status_t, nobody holds a node.
  const NodeHolder& operator[](std::int16_t node) const noexcept;
  /// Forgets all holders, because taktd has restarted.
  void clear();

 private:
  static constexpr std::int16_t highest_node = 127;
  std::string sender_;
  std::array<NodeHolder, highest_node + 1> nodes_;  // by node-ID; 0 is nobody's
};

}  // namespace takt
