#pragma once
#include <cstdint>

#include "eds_parser/values/time.hpp"

namespace takt {

/// Determines from the characters of a terminal for how long a key is held. A terminal does not
/// report that a key is released. It repeats the key while it is held. The first repetition comes
/// after a delay of usually 250 to 660 ms, and the others follow every 20 to 50 ms.
///
///     released --press--> pressed --press--> held
///        ^                   | nothing for     | nothing for
///        +-------------------+ `first`  -------+ `next`, or another key
class DeadMan {
 public:
  /// The times for which a key counts as held without a further character.
  struct Times {
    /// The longest wait for the second character. It is longer than the delay of the terminal.
    Time first;
    /// The longest wait for each later character. It is longer than the time between repetitions.
    Time next;
  };

  explicit DeadMan(Times times) : times_{times} {}

  /// Call this when a character of this direction, 1 or -1, has come.
  void press(int direction, Time now) noexcept;
  /// Call this when another key was pressed or the program was stalled.
  void release() noexcept { state_ = State::released; }
  /// Returns 1 or -1 while the key of this direction is held, else 0.
  int direction(Time now) noexcept;

 private:
  enum class State : std::uint8_t { released, pressed, held };

  Times times_;
  State state_ = State::released;
  int direction_ = 0;
  Time newest_{};
};

}  // namespace takt
