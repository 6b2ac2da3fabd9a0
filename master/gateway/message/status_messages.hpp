#pragma once
#include <cstdint>
#include <deque>
#include <span>
#include <string>
#include <takt/diagnosis_t.hpp>
#include <takt/pdo_status_t.hpp>
#include <takt/status_t.hpp>
#include <takt/sync_status_t.hpp>
#include <takt/timing_t.hpp>
#include <vector>

#include "eds_parser/table/bus_plan.hpp"
#include "master/gateway/notice/emcy_log.hpp"
#include "master/rt/exchange/exchange.hpp"

namespace takt {

/// Fills the summary of the bus state. Changes "since the last message" count from the last call.
class Diagnosis {
 public:
  explicit Diagnosis(const BusPlan& plan) : plan_{plan} {}
  diagnosis_t fill(const StatusSnapshot& snapshot);

 private:
  const BusPlan& plan_;
  std::uint64_t send_failures_ = 0;
  std::uint32_t receive_overruns_ = 0;
  std::uint64_t digest_ = 0;
};

/// Parts of status_t that do not come from the bus thread.
struct GatewayStatus {
  std::uint64_t image_overruns = 0;
  std::uint64_t event_overruns = 0;
  std::uint64_t commands_taken = 0;
  std::uint64_t commands_refused = 0;
  std::vector<std::string> holders;  ///< per node: the sender that commands its outputs
  const EmcyLog* emcys = nullptr;
  std::string stop_text{};  ///< one line for each axis that the ordered stop did not confirm
};

/// Share of the time in which the wire is busy, over about the last second.
class LoadMeter {
 public:
  explicit LoadMeter(std::uint32_t bitrate) : bitrate_{bitrate} {}
  float update(Time now, std::uint64_t wire_bits);

 private:
  struct Sample {
    Time when{};
    std::uint64_t bits = 0;
  };
  std::uint32_t bitrate_;
  std::deque<Sample> samples_;
};

/// The fixed part of status_t.
struct StatusIdentity {
  std::int64_t session = 0;
  std::string interface;
  std::string realtime;
};

/// The state of the bus and of its nodes, with a few nodes per message.
class StatusMessages {
 public:
  StatusMessages(const BusPlan& plan, StatusIdentity identity);
  std::vector<status_t> fill(const StatusSnapshot& snapshot, const GatewayStatus& gateway,
                             Time now);

 private:
  status_t bus_part(const StatusSnapshot& snapshot, const GatewayStatus& gateway, Time now);

  const BusPlan& plan_;
  StatusIdentity identity_;
  LoadMeter load_;
  Diagnosis diagnosis_;
};

histogram_t histogram_message(std::string name, const HistogramSnapshot& times);

/// The histograms of the time since the last call.
class TimingMessages {
 public:
  explicit TimingMessages(std::int64_t session) : session_{session} {}
  /// `sync_to_lcm` measures from SYNC until the front thread has handed the image to LCM.
  timing_t fill(const TimingHistograms& timing, const Histogram& sync_to_lcm, std::uint64_t cycle);

 private:
  std::int64_t session_;
  std::vector<HistogramSnapshot> earlier_;
};

/// Reports the source of SYNC and whether the cycle follows it.
sync_status_t sync_message(const BusPlan& plan, const BusStatus& bus);

/// Most PDOs in one pdo_status_t, which then stays below message_bytes.
inline constexpr std::size_t pdos_a_message = 16;

/// Returns the state of every PDO as messages: TPDOs, then RPDOs, in the order of the plan. `marks`
/// belong to the image of `cycle`; they are empty before the first image.
std::vector<pdo_status_t> pdo_messages(const BusPlan& plan, const StatusSnapshot& snapshot,
                                       std::span<const PdoMark> marks, std::uint64_t cycle);

}  // namespace takt
