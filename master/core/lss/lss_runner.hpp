#pragma once
#include <array>
#include <cstddef>
#include <cstdint>
#include <span>

#include "master/core/lss/lss_master.hpp"

namespace takt {

/// Runs a list of LSS services one after the other, until one of them fails. If a list has brought
/// devices into configuration state and then fails, the runner sends all devices to waiting state.
/// Bus thread only.
///
/// | state              | event                                   | next state | sent          |
/// | ------------------ | --------------------------------------- | ---------- | ------------- |
/// | idle, done, failed | begin()                                 | running    | first service |
/// | running            | a service has succeeded                 | running    | next service  |
/// | running            | the last service has succeeded          | done       |               |
/// | running            | a service has failed                    | failed     |               |
/// | running            | the same, after a device was configured | leaving    | waiting state |
/// | leaving            | the frame was sent                      | failed     |               |
/// | any                | leave(), a device may be configured     | leaving    | waiting state |
/// | any                | leave() otherwise                       | idle       |               |
class LssRunner {
 public:
  /// The largest number of commands in a list, limited by the size of a request.
  static constexpr std::size_t most_commands = 28;

  /// Begins a list. Commands after the first most_commands are not run. `timeout` applies to each
  /// answer; 0 means the defaults of the services.
  void begin(std::span<const LssCommand> commands, Time timeout) noexcept;
  void on_frame(const Frame& frame, Time now, Outbox& out) noexcept;
  void on_time(Time now, Outbox& out) noexcept;
  Time deadline() const noexcept;
  /// Cancels the list. If a device may be in configuration state, the runner first sends all
  /// devices to waiting state; running() stays true until that frame was sent.
  void leave(Time now) noexcept;

  bool running() const noexcept { return state_ == State::running || state_ == State::leaving; }
  /// Results of the services that were run. If the list has failed, the last result says why.
  std::span<const LssResult> results() const noexcept {
    return std::span{results_}.first(results_count_);
  }
  /// Returns true if all services of the list have succeeded.
  bool done() const noexcept { return state_ == State::done; }

  template <class Archive>
  void keep(Archive& state) noexcept {
    state(configured_by_);
  }

 private:
  enum class State : std::uint8_t { idle, running, leaving, done, failed };
  /// The list that may have brought a device into configuration state. The device may still be in
  /// this state.
  enum class ConfiguredBy : std::uint8_t { nobody, earlier_list, this_list };

  void step(Time now) noexcept;
  bool may_configure(const LssCommand& command, LssOutcome outcome) const noexcept;
  void on_result(const LssResult& result, Time now) noexcept;

  LssMaster master_;
  std::array<LssCommand, most_commands> commands_{};
  std::array<LssResult, most_commands> results_{};
  std::size_t count_ = 0;
  std::size_t results_count_ = 0;
  Time timeout_{};
  State state_ = State::idle;
  ConfiguredBy configured_by_ = ConfiguredBy::nobody;
};
static_assert(Machine<LssRunner>);

}  // namespace takt
