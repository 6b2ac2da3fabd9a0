#pragma once
#include <array>
#include <cstdint>
#include <optional>
#include <span>

#include "eds_parser/table/time.hpp"
#include "master/core/event.hpp"
#include "master/wire/frame.hpp"

namespace takt {

/// Notices that two devices have one node id: twice the heartbeats, or two answers to each SDO
/// request. Told at most once in ten seconds.
class TwinWatch {
 public:
  /// `heartbeat_period` of the device; 0 = not known, heartbeats tell nothing. `sdo_request` is
  /// what its SDO server listens to.
  TwinWatch(Time heartbeat_period, CobId sdo_request) noexcept
      : period_{heartbeat_period}, sdo_request_{sdo_request} {}

  std::optional<DuplicateSign> on_heartbeat(Time now) noexcept;
  std::optional<DuplicateSign> on_sdo_answer(const Frame& frame, Time now) noexcept;
  void on_sdo_requests(std::span<const Frame> frames) noexcept;
  /// The device was reset: what was counted before means nothing.
  void restart() noexcept;

  template <class Archive>
  void keep(Archive& state) noexcept {
    state(window_begin_, heartbeats_, full_windows_, asked_, answered_, block_, told_);
    state(objects_);
  }

 private:
  static constexpr Time tell_again = std::chrono::seconds{10};

  std::optional<DuplicateSign> once(DuplicateSign sign, Time now) noexcept;

  Time period_;
  CobId sdo_request_;
  Time window_begin_{};
  std::uint32_t heartbeats_ = 0;
  std::uint32_t full_windows_ = 0;      // in a row, with too many heartbeats
  std::uint32_t asked_ = 0;             // SDO transfers begun
  std::uint32_t answered_ = 0;          // and answered
  bool block_ = false;                  // the newest transfer: its answers are counted otherwise
  std::array<ObjectKey, 2> objects_{};  // of the newest two requests: twins answer those
  Time told_ = -tell_again;             // so long ago that it may be told at once
};

}  // namespace takt
