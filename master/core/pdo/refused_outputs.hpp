#pragma once
#include <cstddef>
#include <cstdint>
#include <vector>

#include "eds_parser/table/bus_plan.hpp"

namespace takt {

/// Remembers which limited outputs had a command outside their limits, and no later command inside
/// them. As long as a node has such an output, its set-points are withheld. `place` is a place of
/// OutputLimits. Bus thread only.
class RefusedOutputs {
 public:
  explicit RefusedOutputs(const BusPlan& plan);

  /// Must be called when the node begins to exchange PDOs. Ends its refusals.
  void open(std::size_t node_index) noexcept;
  /// Notes that a command was outside its limits. Returns true if the previous one was inside.
  bool refuse(std::size_t place, std::uint64_t cycle) noexcept;
  /// Notes that a command was inside its limits. This ends the refusal that refuse() has begun,
  /// from the next cycle on.
  void end(std::size_t place, std::uint64_t cycle) noexcept;
  /// Ends refusals that were not repeated for the time to live of a command.
  void expire(std::uint64_t cycle) noexcept {
    if (holds_any()) end_old(cycle);
  }
  /// Returns true if a command to this node was outside its limits, and no later one was inside.
  bool holds(std::size_t node_index) const noexcept { return held_[node_index] != 0; }
  bool holds_any() const noexcept { return held_nodes_ != 0; }

  template <class Archive>
  void keep(Archive& state) noexcept {
    state(refused_, held_, held_nodes_);
  }

 private:
  enum class State : std::uint8_t { admitted, refused };
  struct Refusal {
    std::uint64_t cycle = 0;  ///< of the newest refused command
    State state = State::admitted;

    template <class Archive>
    void keep(Archive& archive) noexcept {
      archive(cycle, state);
    }
  };
  struct Output {
    std::size_t node_index = 0;
    std::uint64_t longest_pause = 0;  ///< time to live of a command, in cycles
  };

  void change(std::size_t place, State state) noexcept;
  void end_old(std::uint64_t cycle) noexcept;

  std::vector<Output> outputs_;
  std::vector<Refusal> refused_;     ///< parallel to outputs_
  std::vector<std::uint16_t> held_;  ///< by node: number of outputs whose commands are refused
  std::uint32_t held_nodes_ = 0;
};

}  // namespace takt
