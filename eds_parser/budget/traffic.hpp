#pragma once
#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "eds_parser/budget/response_time.hpp"
#include "eds_parser/report/source.hpp"
#include "eds_parser/table/bus_plan.hpp"

namespace takt {

/// Assumptions of the analysis about values that the plan does not contain.
struct BudgetOptions {
  /// Time that the slowest device needs from the end of SYNC until its TPDO is ready to be sent.
  Time device_time = std::chrono::microseconds{30};
  Time emcy_interval =
      std::chrono::milliseconds{100};  ///< shortest distance of two EMCYs of a node
  WireErrors errors{};
};

/// The purpose of a frame.
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

/// The reason for which a frame must have ended at some time.
enum class BudgetLimit : std::uint8_t {
  none,
  receive_window,  ///< receive window of the master; a PDO that ends later counts as missing
  /// Output deadline of the master, if it is earlier than the end of the receive window.
  output_deadline,
  sync_window,  ///< 0x1007 of the devices
  own_period,   ///< the next frame of the same kind comes
  timeout,      ///< the receiver's time-out expires: SDO time-out, heartbeat consumer
};

/// All frames of one identifier and sender.
struct TrafficFrame {
  std::string name;  ///< "TPDO1 shoulder"
  Traffic kind = Traffic::nmt;
  CobId cob_id{};
  bool remote_request = false;
  bool from_master = false;
  bool in_cycle = false;  ///< SYNC, a TPDO that follows it at once, or an output
  bool awaited = false;   ///< the master sends nothing else before this frame has arrived
  std::uint8_t bytes = 0;
  std::uint16_t every = 1;              ///< in_cycle: number of SYNCs from one frame to the next
  std::optional<std::uint16_t> turn{};  ///< SYNC number modulo `every`, if it is certain
  unsigned burst = 1;                   ///< number of frames at once
  Time frame{};                         ///< bus time of one frame with worst stuffing
  Time period{};                        ///< shortest time between two frames
  Time jitter{};
  bool period_assumed = false;
  bool on_change = false;       ///< the frame is sent when its values change, not periodically
  std::optional<Time> limit{};  ///< longest time from being queued to its end
  BudgetLimit why = BudgetLimit::none;
  std::string waits{};   ///< timeout: the receiver that waits, for example "arm (0x1016)"
  bool answers = false;  ///< an answer, whose limit counts from the moment its request was queued

  bool by_itself() const noexcept { return !from_master && !in_cycle; }
  bool is_input() const noexcept { return in_cycle && kind == Traffic::tpdo; }
  bool is_output() const noexcept { return in_cycle && kind == Traffic::rpdo; }
  /// Returns whether the master sends this frame outside the cycle.
  bool is_service() const noexcept { return from_master && !in_cycle; }
  bool is_answer() const noexcept { return kind == Traffic::sdo && !from_master; }
};

/// The frames of a bus in order of priority, the highest first.
struct BusTraffic {
  std::vector<TrafficFrame> frames;
  unsigned service_dialogues = 0;          ///< as in BusBudget
  Time service_round{};                    ///< as in BusBudget
  std::vector<std::string> assumptions{};  ///< one sentence each
};

/// Shares of the bus capacity; 1 is the whole capacity.
struct BusLoad {
  double typical = 0;   ///< SYNC, PDOs, error control and TIME, with a usual number of stuff bits
  double worst = 0;     ///< the traffic of `typical` with worst stuffing
  double services = 0;  ///< greatest share of SDO, in addition to `worst`
};

BusTraffic bus_traffic(const BusPlan& plan, const BudgetOptions& options);

BusLoad bus_load(const BusTraffic& traffic, std::uint32_t bitrate) noexcept;

/// Returns one sentence for each TPDO that is enabled in its device but that the master does not
/// exchange. The device may send it, but the plan does not contain it and the budget does not count
/// it.
std::vector<std::string> left_out_tpdos(const Findings& findings);

}  // namespace takt
