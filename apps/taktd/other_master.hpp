#pragma once
#include <cstdint>
#include <optional>
#include <string>
#include <takt/status_t.hpp>
#include <vector>

#include "eds_parser/table/bus_plan.hpp"
#include "eds_parser/table/time.hpp"
#include "master/wire/frame.hpp"

namespace takt {

/// Whether a bus has a master already, found out before the first frame is sent: by a heartbeat of
/// the master's own node id, and by BUS_STATUS of a bus of the same name. Pure: frames and messages
/// in, sentences out.
class OtherMaster {
 public:
  /// What a BUS_STATUS of another session does. It carries no proof of who sent it: where the bus
  /// has keys, it only warns, or everybody on LCM could keep this master from starting.
  enum class StatusCounts : std::uint8_t { as_refusal, as_warning };

  /// `bus` is what sentences call the bus; `session` is our own.
  OtherMaster(const BusPlan& plan, std::string bus, std::int64_t session,
              StatusCounts status = StatusCounts::as_refusal);

  /// How long frames have to be listened to: one and a half times the producer time of the master's
  /// heartbeat, which the other master is taken to have too, within 150 ms .. 1.5 s.
  Time listening_time() const noexcept;

  void on_frame(const Frame& frame);
  /// A status counts when it was sent within the last five seconds (a log that is replayed is
  /// older), and only of one that has sent frames: a daemon that observes is no master.
  void on_status(const status_t& status, Time realtime);

  /// Why we may not be the master.
  const std::optional<std::string>& refusal() const noexcept { return refusal_; }
  /// What speaks for another master and doesn't prove it: somebody else makes SYNC, or a status
  /// that counts as a warning. One sentence for each of them.
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
