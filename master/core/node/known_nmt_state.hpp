#pragma once
#include <cstdint>

#include "eds_parser/table/boot_plan.hpp"
#include "master/wire/nmt.hpp"

namespace takt {

/// The NMT state of a node, as its boot knows it from the reports of the node and from the NMT
/// commands of this boot.
class KnownNmtState {
 public:
  /// Notes that the node has sent a boot-up message.
  void on_bootup() noexcept {
    reported_ = NmtState::bootup;
    bootup_seen_ = true;
    preoperational_ = false;
    effect_ = Effect::none;
  }
  /// Notes that the node has reported its state by a heartbeat or a guarding answer.
  void on_heartbeat(NmtState state) noexcept {
    reported_ = state;
    heartbeat_seen_ = true;
    preoperational_ = state == NmtState::preoperational;
  }
  /// Notes that a command of the boot plan was sent.
  void commanded(NmtCommand command) noexcept {
    if (command == NmtCommand::start) effect_ = Effect::started;
    if (!is_reset(command)) return;
    reported_ = NmtState::unknown;
    bootup_seen_ = preoperational_ = false;
    effect_ = Effect::none;
    reset_sent_ = true;
  }
  /// Notes that PRE-OPERATIONAL was sent before a write.
  void commanded_preoperational() noexcept {
    if (reported_ == NmtState::operational) note_taken_out();
    preoperational_ = true;
  }
  /// Notes that the device refuses a write because of its state, so it has left PRE-OPERATIONAL by
  /// itself.
  void left_preoperational() noexcept { preoperational_ = false; }
  /// Notes that the boot has taken the node out of OPERATIONAL.
  void note_taken_out() noexcept { effect_ = Effect::taken_out; }

  /// Returns the newest state that the node has reported in this boot.
  NmtState reported() const noexcept { return reported_; }
  bool heartbeat_seen() const noexcept { return heartbeat_seen_; }
  bool bootup_seen() const noexcept { return bootup_seen_; }
  /// Returns true if the node was commanded to or reports PRE-OPERATIONAL, and has reported no
  /// other state since.
  bool preoperational() const noexcept { return preoperational_; }
  /// Returns true if this boot has sent a reset.
  bool reset_sent() const noexcept { return reset_sent_; }
  /// Returns true if this boot has started the node.
  bool started() const noexcept { return effect_ == Effect::started; }
  /// Returns true if this boot has taken the node out of OPERATIONAL, and has not started it since.
  bool taken_out() const noexcept { return effect_ == Effect::taken_out; }

 private:
  /// The effect of the commands of this boot on the state OPERATIONAL.
  enum class Effect : std::uint8_t { none, taken_out, started };

  NmtState reported_ = NmtState::unknown;
  Effect effect_ = Effect::none;
  bool preoperational_ = false;
  bool heartbeat_seen_ = false;
  bool bootup_seen_ = false;
  bool reset_sent_ = false;
};

}  // namespace takt
