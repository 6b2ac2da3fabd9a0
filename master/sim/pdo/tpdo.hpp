#pragma once
#include <cstdint>

#include "eds_parser/values/time.hpp"
#include "master/sim/pdo/device_traits.hpp"
#include "master/sim/pdo/pdo_record.hpp"
#include "master/sim/service/transmitter.hpp"

namespace takt::sim {

/// One TPDO of a device, which is sampled and sent by SYNC, by event, by timer or on request. CiA
/// 301, 7.2.2 and 7.5.2.37.
class Tpdo {
 public:
  explicit Tpdo(PdoRecord record) : record_{record} {}

  void set_traits(const DeviceTraits& traits) noexcept { traits_ = traits; }
  const PdoRecord& record() const noexcept { return record_; }
  /// Enters the state that a TPDO has on entering OPERATIONAL: an event is pending (unless the
  /// traits say otherwise) and counters are zero.
  void start(Time now) noexcept;
  void stop() noexcept { running_ = active_ = false; }
  /// Call this after a write to one of the objects of this TPDO.
  void reconfigure(Time now) noexcept;
  /// Call this after the objects of this TPDO were changed without a write by SDO. The new values
  /// take effect at the next start or write, but an invalid COB-ID ends the TPDO at once.
  void look_at_record() noexcept;

  /// Takes a SYNC. The frame of this TPDO may be on the wire from `ready` on; after `window_end`
  /// the frame is dropped.
  void on_sync(std::uint8_t counter, Time ready, Time window_end, Transmitter& out) noexcept {
    if (active_) sample_at_sync(counter, ready, window_end, out);
  }
  void on_request(Time ready, Transmitter& out) noexcept;
  /// Answers the RPDO with the same number, which was received.
  void answer(Time ready, Transmitter& out) noexcept;
  /// Called when mapped values may have changed.
  void notice(Time now, Transmitter& out) noexcept {
    if (wants_events()) look_for_event(now, out);
  }
  void on_time(Time now, Transmitter& out) noexcept;
  Time deadline() const noexcept { return deadline_; }
  /// Returns false if neither SYNC nor time nor changes of values have an effect until start(),
  /// reconfigure() or look_at_record().
  bool live() const noexcept { return active_ || deadline_ != never; }
  /// Returns true if changes of mapped values are events.
  bool wants_events() const noexcept {
    return active_ && (type_ == 0 || type_ >= 254) && has_events();
  }

 private:
  void look_for_event(Time now, Transmitter& out) noexcept;
  bool has_events() const noexcept;
  void sample_at_sync(std::uint8_t counter, Time ready, Time window_end, Transmitter& out) noexcept;
  bool counts_to_its_turn(std::uint8_t counter) noexcept;
  void send(std::uint64_t data, Time ready, Time expires, Transmitter& out) noexcept;
  void event(Time ready, Transmitter& out) noexcept;
  bool runs_by_timer() const noexcept;
  bool only_answers() const noexcept;
  Time inhibit() const noexcept;
  void update_deadline() noexcept;

  PdoRecord record_;
  DeviceTraits traits_;
  std::uint8_t type_ = 255;
  bool running_ = false;
  bool active_ = false;     ///< running and valid; false for a multiplexed PDO, which is not sent
                            ///< as a whole
  bool pending_ = false;    ///< an event that has not been sent yet
  bool sampled_ = false;    ///< type 252: sample_ is valid
  bool started_ = false;    ///< the SYNC start value has been seen
  std::uint8_t count_ = 0;  ///< SYNCs since the last transmission
  std::uint64_t last_ = 0;  ///< data of the newest frame
  std::uint64_t seen_ = 0;  ///< data at the newest check for changes
  std::uint64_t sample_ = 0;
  Time allowed_from_{};  ///< end of the inhibit time
  Time timer_ = never;   ///< expiry of the event timer
  Time deadline_ = never;
  PdoMapping mapping_;  ///< last member because it is large
};

}  // namespace takt::sim
