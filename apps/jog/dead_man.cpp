#include "apps/jog/dead_man.hpp"

namespace takt {

void DeadMan::press(int direction, Time now) noexcept {
  const bool goes_on = this->direction(now) == direction;
  state_ = goes_on ? State::held : State::pressed;
  direction_ = direction;
  newest_ = now;
}

int DeadMan::direction(Time now) noexcept {
  const Time longest = state_ == State::held ? times_.next : times_.first;
  if (now - newest_ > longest) state_ = State::released;
  return state_ == State::released ? 0 : direction_;
}

}  // namespace takt
