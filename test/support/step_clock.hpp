#pragma once
#include <memory>

#include "eds_parser/table/time.hpp"

namespace takt::test {

/// A clock that goes on by `step` each time that somebody reads it, and by hand. Copies share it.
class StepClock {
 public:
  explicit StepClock(Time step) : state_{std::make_shared<State>(State{Time{1}, step})} {}

  Time operator()() const { return state_->now += state_->step; }
  void pass(Time span) const { state_->now += span; }

 private:
  struct State {
    Time now;
    Time step;
  };
  std::shared_ptr<State> state_;
};

}  // namespace takt::test
