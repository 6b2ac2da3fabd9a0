#pragma once
#include <cstdint>
#include <optional>
#include <string>
#include <takt/status_t.hpp>

#include "eds_parser/table/bus_plan.hpp"
#include "eds_parser/table/time.hpp"
#include "master/wire/frame.hpp"

namespace takt {

/// Whether a bus has a master already, found out before the first frame is sent: by a heartbeat of
/// the master's own node id, and by BUS_STATUS of a bus of the same name. Pure: frames and messages
/// in, sentences out.
class OtherMaster {
 public:
  /// `bus` is what sentences call the bus; `session` is our own.
  OtherMaster(const BusPlan& plan, std::string bus, std::int64_t session);

  /// How long frames have to be listened to: one and a half times the producer time of the master's
  /// heartbeat, which the other master is taken to have too, within 150 ms .. 1.5 s.
  Time listening_time() const noexcept;

  void on_frame(const Frame& frame);
  /// A status counts when it was sent within the last five seconds (a log that is replayed is
  /// older), and only of one that has sent frames: a daemon that observes is no master.
  void on_status(const status_t& status, Time realtime);

  /// Why we may not be the master.
  const std::optional<std::string>& refusal() const noexcept { return refusal_; }
  /// Somebody makes SYNC, and so shall we.
  const std::optional<std::string>& warning() const noexcept { return warning_; }

 private:
  const BusPlan& plan_;
  std::string bus_;
  std::int64_t session_;
  std::optional<std::string> refusal_;
  std::optional<std::string> warning_;
};

}  // namespace takt
