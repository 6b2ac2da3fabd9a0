#pragma once
#include <cstdint>
#include <optional>
#include <vector>

#include "eds_parser/budget/traffic.hpp"
#include "eds_parser/table/bus_plan.hpp"

namespace takt {

/// When a frame of a network may be sent.
enum class Sent : std::uint8_t {
  sync,        ///< each period
  after_sync,  ///< by devices
  outputs,     ///< with the outputs of the master
  by_itself,   ///< by devices, at any time, but not within `distance` of the frame before
  as_emcy,     ///< by devices, all at once
  in_slack,    ///< by the master, between the inputs and the outputs
  on_request,  ///< by devices, behind a remote request
};

/// One frame of a network as the standard and the plan define it, without use of the budget.
struct PlanFrame {
  CobId cob_id;
  std::uint8_t bytes = 0;
  bool remote_request = false;
  Traffic kind = Traffic::nmt;
  Sent sent = Sent::by_itself;
  bool awaited = false;  ///< after_sync: the master waits for it
  unsigned every = 1;    ///< after_sync, outputs: number of SYNCs from one frame to the next
  unsigned turn = 0;     ///< after_sync: number of the SYNC, modulo `every`
  Time distance{};       ///< shortest time between two frames
  unsigned burst = 1;
  std::optional<std::size_t> answer{};  ///< position of the answer to a remote request
};

/// The number of SDO dialogues, which a plan does not contain.
struct Dialogues {
  unsigned count = 0;
  Time round{};
};

/// Returns all frames that may be on the bus: PDOs by their types, times and polls, heartbeats,
/// guarding with its requests, EMCYs, NMT, TIME and SDO.
std::vector<PlanFrame> traffic_of(const BusPlan& plan, Dialogues dialogues);

}  // namespace takt
