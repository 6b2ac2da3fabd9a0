#pragma once
#include <memory>

#include "eds_parser/values/time.hpp"

namespace takt::test {

/// A clock that advances by `step` at each reading, and by pass(). Copies share the same time.
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
