#pragma once
#include <cstddef>

#include "master/core/event_queue.hpp"
#include "master/rt/port.hpp"

namespace takt {

/// Turns changes of PortCondition and failed sends into events and reports each of them once. Bus
/// thread only.
class PortWatch {
 public:
  explicit PortWatch(EventQueue& events) noexcept : events_{events} {}

  void on_condition(const PortCondition& condition, Time now) noexcept;
  /// Reports that the interface refused `unsent` frames with `error`; `unsent` is 0 if all went
  /// out.
  void on_send(std::size_t unsent, int error, Time now) noexcept;

  template <class Archive>
  void keep(Archive& state) noexcept {
    state(seen_, last_full_, full_reported_);
  }

 private:
  EventQueue& events_;
  PortCondition seen_;
  Time last_full_{};
  bool full_reported_ = false;
};

}  // namespace takt
