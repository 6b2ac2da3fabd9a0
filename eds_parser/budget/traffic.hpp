#pragma once
#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "eds_parser/budget/response_time.hpp"
#include "eds_parser/table/bus_plan.hpp"

namespace takt {

/// What the analysis takes for granted where the plan does not say it.
struct BudgetOptions {
  /// Of the slowest device, from the end of SYNC to its TPDO being ready for the bus.
  Time device_time = std::chrono::microseconds{30};
  Time emcy_interval = std::chrono::milliseconds{100};  ///< least distance of two EMCYs of a node
  WireErrors errors{};
};

/// What a frame is on the bus for.
enum class Traffic : std::uint8_t {
  nmt,
  time,
  sync,
  emcy,
  tpdo,
  rpdo,
  sdo,            ///< requests and answers
  remote,         ///< remote requests: guarding, polled TPDOs
  error_control,  ///< heartbeats, answers to guarding
};

/// Why a frame must be through at some time.
enum class BudgetLimit : std::uint8_t {
  none,
  receive_window,   ///< of the master: later it counts as missing
  output_deadline,  ///< the same, where it comes before that window
  sync_window,      ///< 0x1007 of the devices
  own_period,       ///< its next frame comes
  patience,         ///< somebody waits for it no longer: SDO timeout, heartbeat consumer
};

/// All frames of one identifier and sender.
struct TrafficFrame {
  std::string name;  ///< "TPDO1 shoulder"
  Traffic kind = Traffic::nmt;
  CobId cob_id{};
  bool remote_request = false;
  bool from_master = false;
  bool in_cycle = false;  ///< SYNC, what follows it at once, what goes out with the outputs
  bool awaited = false;   ///< the master does nothing else before it is there
  std::uint8_t bytes = 0;
  std::uint16_t every = 1;              ///< in_cycle: SYNCs from one to the next
  std::optional<std::uint16_t> turn{};  ///< SYNC number modulo `every`, where it is certain
  unsigned burst = 1;                   ///< so many at once
  Time frame{};                         ///< one, with worst stuffing
  Time period{};                        ///< least distance of two
  Time jitter{};
  bool period_assumed = false;
  bool on_change = false;       ///< sent when its values change, not by time
  std::optional<Time> limit{};  ///< from being queued to its end
  BudgetLimit why = BudgetLimit::none;
  std::string waits{};   ///< patience: whose, "arm (0x1016)"
  bool answers = false;  ///< the limit counts from its request being queued

  bool by_itself() const noexcept { return !from_master && !in_cycle; }
};

/// The frames of a bus, the highest priority first.
struct BusTraffic {
  std::vector<TrafficFrame> frames;
  unsigned service_dialogues = 0;  ///< requests with their answers in one `service_round`
  Time service_round{};
  std::vector<std::string> assumptions{};  ///< a sentence each
};

BusTraffic bus_traffic(const BusPlan& plan, const BudgetOptions& options);

}  // namespace takt
