#pragma once
#include <cstdint>
#include <optional>

#include "eds_parser/table/time.hpp"
#include "master/core/node_status.hpp"
#include "master/wire/emcy.hpp"
#include "master/wire/heartbeat.hpp"

namespace takt {

/// What a node tells of itself: NMT state by heartbeat, silence, EMCY. Writes it to the NodeStatus.
class NodeWatch {
 public:
  /// `heartbeat_timeout`: longest silence, 0 = not watched.
  explicit NodeWatch(Time heartbeat_timeout) noexcept : timeout_{heartbeat_timeout} {}

  enum class Sign : std::uint8_t { bootup, same_state, new_state };

  /// The consumer is armed by the first heartbeat; a boot-up message is none and disarms it. CiA
  /// 301, 7.2.8.2.2.
  Sign on_heartbeat(NmtState state, Time now, NodeStatus& status) noexcept;
  /// The node was told to reset, or silence is expected for another reason.
  void disarm() noexcept { deadline_ = never; }
  /// The master itself was away for so long: nobody is silent for that.
  void excuse(Time away) noexcept {
    if (deadline_ != never) deadline_ += away;
  }
  Time deadline() const noexcept { return deadline_; }
  /// Time of silence when the heartbeat is lost, told once; the next heartbeat arms it again.
  std::optional<Time> on_time(Time now, NodeStatus& status) noexcept;
  /// The node is silent, as another way of watching it has found out.
  void note_loss(NodeStatus& status) noexcept;

  /// Counts it. True: worth telling; a node that floods is told of ten times a second at most.
  bool on_emcy(const Emcy& emcy, Time now, NodeStatus& status) noexcept;
  /// EMCYs that were not told since the last call.
  std::uint32_t take_untold_emcys() noexcept;

  template <class Archive>
  void keep(Archive& state) noexcept {
    state(deadline_, emcy_window_, emcys_in_window_, untold_emcys_);
  }

 private:
  static constexpr std::uint32_t emcys_per_second = 10;

  Time timeout_;
  Time deadline_ = never;
  Time emcy_window_{};  // begin of the second in which EMCYs are counted
  std::uint32_t emcys_in_window_ = 0;
  std::uint32_t untold_emcys_ = 0;
};

}  // namespace takt
