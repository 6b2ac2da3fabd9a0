#pragma once
#include <array>
#include <cstdint>
#include <optional>
#include <span>

#include "eds_parser/values/time.hpp"
#include "master/core/event.hpp"
#include "master/wire/frame.hpp"

namespace takt {

/// Detects that two devices use one node-ID. The signs are twice the expected number of heartbeats,
/// and two answers to each SDO request. They are reported at most once in ten seconds. Bus thread
/// only.
class DuplicateNodeWatch {
 public:
  /// `heartbeat_period` is that of the device; 0 means that it is not known and heartbeats are not
  /// evaluated. `sdo_request` is the COB-ID on which the SDO server of the device listens.
  DuplicateNodeWatch(Time heartbeat_period, CobId sdo_request) noexcept
      : period_{heartbeat_period}, sdo_request_{sdo_request} {}

  /// Takes a heartbeat. Returns the sign that has shown two devices, if any.
  std::optional<DuplicateSign> on_heartbeat(Time now) noexcept;
  /// Takes a frame of the SDO server. Returns the sign that has shown two devices, if any.
  std::optional<DuplicateSign> on_sdo_answer(const Frame& frame, Time now) noexcept;
  /// Takes the frames that the master sends to the node, and counts the SDO requests among them.
  void on_sdo_requests(std::span<const Frame> frames) noexcept;
  /// Clears all counters, because the device was reset.
  void restart() noexcept;

  template <class Archive>
  void keep(Archive& state) noexcept {
    state(window_begin_, heartbeats_, full_windows_, asked_, answered_, block_, reported_);
    state(objects_);
  }

 private:
  static constexpr Time report_again = std::chrono::seconds{10};

  std::optional<DuplicateSign> once(DuplicateSign sign, Time now) noexcept;

  Time period_;
  CobId sdo_request_;
  Time window_begin_{};
  std::uint32_t heartbeats_ = 0;
  std::uint32_t full_windows_ = 0;  // windows in a row with too many heartbeats
  std::uint32_t asked_ = 0;         // SDO transfers that were begun
  std::uint32_t answered_ = 0;      // SDO transfers that were answered
  // The newest transfer is a block transfer, whose answers are counted differently.
  bool block_ = false;
  // Objects of the newest two requests, which both devices answer.
  std::array<ObjectKey, 2> objects_{};
  Time reported_ =
      -report_again;  // initially long ago, so that the first report is possible at once
};

}  // namespace takt
