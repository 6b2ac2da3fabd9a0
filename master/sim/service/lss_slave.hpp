#pragma once
#include <cstdint>
#include <utility>

#include "eds_parser/values/time.hpp"
#include "master/sim/dictionary/object_store.hpp"
#include "master/sim/service/transmitter.hpp"

namespace takt::sim {

/// The device side of LSS: keeps and changes the node-ID and the bit rate of a device. CiA 305.
class LssSlave {
 public:
  static constexpr std::uint8_t none = 255;  ///< node-ID value that means "no node-ID"

  struct Faults {
    bool silent = false;         ///< the slave does not answer
    bool refuses_store = false;  ///< store configuration fails with error code 2
  };

  /// `node_id` is the node-ID at the first power-on, when the bit rate is that of the bus. The
  /// identity comes from 0x1018.
  LssSlave(ObjectStore& store, std::uint8_t node_id);

  static CobId id() noexcept { return CobId::base(0x7E5); }

  /// Activates the stored configuration.
  void power_on() noexcept;
  /// Activates the pending node-ID at an NMT reset.
  void reset() noexcept;
  void on_frame(const Frame& frame, Time now, Transmitter& out) noexcept;
  /// Changes the bit rate between two pauses of equal length.
  void on_time(Time now) noexcept;
  Time deadline() const noexcept {
    return switching() ? (switched_ ? ends_at_ : switch_at_) : never;
  }

  std::uint8_t node_id() const noexcept { return active_; }
  /// Returns the bit rate in kbit/s; 0 means that LSS has never changed it.
  std::uint16_t bit_rate() const noexcept { return rate_; }
  /// Returns true while a change of the bit rate is in progress and the device neither sends nor
  /// receives.
  bool switching() const noexcept { return ends_at_ != never; }
  /// Returns true once after a device without a node-ID has received one and left the configuration
  /// state.
  bool take_start() noexcept { return std::exchange(start_, false); }
  Faults& faults() noexcept { return faults_; }
  bool in_configuration() const noexcept { return state_ == State::configuration; }

 private:
  enum class State : std::uint8_t { waiting, configuration };

  void switch_to(State state) noexcept;
  void on_select(const Frame& frame, Time now, Transmitter& out) noexcept;
  void on_range(const Frame& frame, Time now, Transmitter& out) noexcept;
  void on_fast_scan(const Frame& frame, Time now, Transmitter& out) noexcept;
  void on_configuration(const Frame& frame, Time now, Transmitter& out) noexcept;
  void set_node_id(std::uint8_t id, Time now, Transmitter& out) noexcept;
  void set_bit_rate(std::uint8_t table, std::uint8_t entry, Time now, Transmitter& out) noexcept;
  void answer(std::uint8_t command, std::uint32_t value, Time ready, Transmitter& out) noexcept;
  std::uint32_t identity(std::uint8_t part) const noexcept;
  bool without_id() const noexcept { return active_ == none && pending_ == none; }

  ObjectStore& store_;
  Faults faults_;
  State state_ = State::waiting;
  std::uint8_t active_;
  std::uint8_t pending_;
  std::uint8_t stored_;
  std::uint16_t rate_ = 0;
  std::uint16_t pending_rate_ = 0;
  std::uint16_t stored_rate_ = 0;
  std::uint8_t selected_ = 0;  ///< matched parts of a selective switch, in order
  std::uint8_t in_range_ = 0;  ///< matched parts of an identify request, in order
  std::uint8_t scanned_ = 0;   ///< part of the identity that fastscan has reached
  bool start_ = false;
  bool switched_ = false;
  Time switch_at_ = never;
  Time ends_at_ = never;
};

}  // namespace takt::sim
