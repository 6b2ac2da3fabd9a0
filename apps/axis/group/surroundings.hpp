#pragma once
#include <chrono>
#include <cstdint>
#include <poll.h>
#include <ratio>
#include <span>

namespace takt {

/// The clocks, waits and random numbers that the axis library uses. By default, the machine on
/// which the program runs provides them. A simulation gives a thread other surroundings, see
/// UseSurroundings.
class Surroundings {
 public:
  virtual ~Surroundings() = default;
  /// Monotonic time, the time base of images.
  virtual std::chrono::nanoseconds now() = 0;
  /// Time since 1970.
  virtual std::chrono::nanoseconds wall() = 0;
  /// Waits until one of the descriptors is ready, but at most for `longest`.
  virtual void wait(std::span<pollfd> descriptors, std::chrono::nanoseconds longest) = 0;
  /// Returns a number in 1..2^63-1 that no other program has.
  virtual std::int64_t random_number() = 0;
};

/// Returns the surroundings of this thread.
Surroundings& surroundings() noexcept;

/// Gives this thread other surroundings as long as this object lives.
class UseSurroundings {
 public:
  explicit UseSurroundings(Surroundings& others) noexcept;
  ~UseSurroundings();
  UseSurroundings(const UseSurroundings&) = delete;
  UseSurroundings& operator=(const UseSurroundings&) = delete;

 private:
  Surroundings* before_;
};

/// The monotonic clock of the surroundings of this thread.
struct ProgramClock {
  using duration = std::chrono::nanoseconds;
  using rep = duration::rep;
  using period = duration::period;
  using time_point = std::chrono::time_point<ProgramClock>;
  static constexpr bool is_steady = true;

  static time_point now() { return time_point{surroundings().now()}; }
};

}  // namespace takt
