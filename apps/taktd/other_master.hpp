#pragma once
#include <cstdint>
#include <optional>
#include <string>
#include <takt/status_t.hpp>
#include <vector>

#include "eds_parser/table/bus_plan.hpp"
#include "eds_parser/values/time.hpp"
#include "master/wire/frame.hpp"

namespace takt {

/// Finds out, before the first frame is sent, whether the bus already has a master: from a
/// heartbeat with the master's own node-ID, and from BUS_STATUS of a bus of the same name. The
/// class does no input or output: it takes frames and messages and returns sentences.
class OtherMaster {
 public:
  /// The effect of a BUS_STATUS of another session. The message does not prove who sent it. On a
  /// bus with keys it therefore only causes a warning: a refusal would let everybody on LCM keep
  /// this master from starting.
  enum class StatusCounts : std::uint8_t { as_refusal, as_warning };

  /// `bus` is the name of the bus in sentences; `session` is the session of this daemon.
  OtherMaster(const BusPlan& plan, std::string bus, std::int64_t session,
              StatusCounts status = StatusCounts::as_refusal);

  /// Returns how long to listen for frames: 1.1 times the producer time of this master's heartbeat,
  /// limited to 1.1 s .. 5 s. This assumes that the other master has the same producer time.
  Time listening_time() const noexcept;

  void on_frame(const Frame& frame);
  /// Takes a status. It counts if its time stamp is within five seconds of `realtime` (messages of
  /// a replayed log are older) and if its sender has sent frames: a daemon that only observes is no
  /// master.
  void on_status(const status_t& status, Time realtime);

  /// Returns the reason why this daemon may not be the master. It is empty if this daemon may be
  /// the master.
  const std::optional<std::string>& refusal() const noexcept { return refusal_; }
  /// Returns signs of another master that are no proof, one sentence each: a foreign SYNC producer,
  /// or a status that counts as a warning.
  std::vector<std::string> warnings() const;

 private:
  const BusPlan& plan_;
  std::string bus_;
  std::int64_t session_;
  StatusCounts status_;
  std::optional<std::string> refusal_;
  std::optional<std::string> sync_warning_;
  std::optional<std::string> status_warning_;
};

}  // namespace takt
