#pragma once
#include <array>
#include <cstdint>
#include <optional>
#include <utility>

#include "eds_parser/table/time.hpp"
#include "master/sim/object_store.hpp"
#include "master/sim/transmitter.hpp"

namespace takt::sim {

/// The device's half of LSS: node id and bit rate of a device, and how they are changed. CiA 305.
class LssSlave {
 public:
  static constexpr std::uint8_t none = 255;  ///< as node id: it has none

  struct Faults {
    bool silent = false;         ///< answers nothing
    bool refuses_store = false;  ///< error 2
  };

  /// `node_id` of the very first power-on; its bit rate is that of the bus. The identity is 0x1018.
  LssSlave(ObjectStore& store, std::uint8_t node_id);

  static CobId id() noexcept { return CobId::base(0x7E5); }

  /// Takes what was stored.
  void power_on() noexcept;
  /// NMT reset: what was configured counts from here on.
  void reset() noexcept;
  void on_frame(const Frame& frame, Time now, Transmitter& out) noexcept;
  /// The bit rate is changed in the middle of two pauses of equal length.
  void on_time(Time now) noexcept;
  Time deadline() const noexcept {
    return switching() ? (switched_ ? ends_at_ : switch_at_) : never;
  }

  std::uint8_t node_id() const noexcept { return active_; }
  /// kbit/s; 0: never changed
  std::uint16_t bit_rate() const noexcept { return rate_; }
  /// Nothing is sent or heard: a change of the bit rate is under way.
  bool switching() const noexcept { return ends_at_ != never; }
  /// True once: a device without node id has got one and leaves configuration state.
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
  std::uint8_t selected_ = 0;  ///< parts of the selection that have matched in order
  std::uint8_t in_range_ = 0;  ///< parts of an identification that have matched in order
  std::uint8_t scanned_ = 0;   ///< part that the fastscan is at
  bool start_ = false;
  bool switched_ = false;
  Time switch_at_ = never;
  Time ends_at_ = never;
};

}  // namespace takt::sim
