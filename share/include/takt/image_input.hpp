#pragma once
/// @file
/// The process image of a bus on LCM, assembled from the messages of taktd.
#include <cstddef>
#include <cstdint>
#include <takt/image_t.hpp>
#include <takt/layout_t.hpp>
#include <vector>

namespace takt {

/// Assembles the layout and the newest complete image from the messages of taktd, which may come in
/// several parts. Parts that do not belong together (another session, layout or cycle) are ignored.
///
/// One forged or late message changes nothing. An image is ignored if its cycle number is lower
/// than the newest one, or more than one second ahead (16 cycles if that is longer). The third of
/// such images in a row is accepted if their cycle numbers rise and lie close together. A layout
/// that differs, or that comes from another session, counts only if no image of the present session
/// has arrived for `quiet_ns`, or for 20 periods of SYNC if that is longer.
///
/// The class uses neither LCM nor a clock. All calls come from one thread.
class ImageInput {
 public:
  /// Shortest silence of the present session before another layout counts, nanoseconds.
  static constexpr std::int64_t quiet_ns = 200'000'000;

  /// Sets the time of the messages that follow, in nanoseconds of a monotonic clock.
  void set_time(std::int64_t now_ns) noexcept { now_ns_ = now_ns; }
  /// Takes one part of a layout. Returns true if this part completes a layout that differs from the
  /// present one.
  bool take(const layout_t& part);
  /// Takes one part of an image. Returns true if this part completes a newer image.
  bool take(const image_t& part);

  /// Returns true if a complete layout has arrived.
  bool has_layout() const noexcept { return !signals_.empty(); }
  /// Returns true if a complete image has arrived since the layout.
  bool has_image() const noexcept { return has_image_; }
  /// Returns the signals of the layout, in the order of values(): name, node, object, unit and
  /// scale of each value. SI value = raw value * scale + offset.
  const std::vector<signal_t>& signals() const noexcept { return signals_; }
  /// Returns the session of the layout: a number that identifies one run of taktd.
  std::int64_t session() const noexcept { return session_; }
  /// Returns the period of SYNC in nanoseconds, 0 before the first layout.
  std::int64_t period_ns() const noexcept { return period_ns_; }
  /// Returns the cycle number of the newest image, -1 before the first image.
  std::int64_t cycle() const noexcept { return cycle_; }
  /// Returns the raw values of the newest image, one for each signal; all are 0 before the first
  /// image.
  const std::vector<std::int64_t>& values() const noexcept { return values_; }
  /// Returns true if the PDO of this signal did not arrive when expected. `signal` is an index into
  /// signals().
  bool stale(std::size_t signal) const noexcept { return stale_[signal] != 0; }

 private:
  /// Records which parts of a layout or an image have arrived.
  struct Parts {
    std::vector<char> seen;
    std::size_t missing = 0;
    void restart(std::size_t count);
    bool mark(std::size_t part);  // returns false if the part is a repetition or out of range
  };

  void begin(const layout_t& part);
  void finish();
  bool belongs(const image_t& part) const noexcept;
  bool session_lives() const noexcept;
  bool is_next(std::int64_t cycle) const noexcept;
  bool is_confirmed(std::int64_t cycle) noexcept;

  std::vector<signal_t> signals_;
  std::int64_t session_ = 0;
  std::int64_t hash_ = 0;
  std::int64_t period_ns_ = 0;

  std::vector<signal_t> new_signals_;
  std::int64_t new_session_ = 0;
  std::int64_t new_hash_ = 0;
  std::int64_t new_period_ns_ = 0;
  Parts layout_parts_;

  std::int64_t now_ns_ = 0;
  std::int64_t image_ns_ = 0;  // time at which the newest image arrived

  bool has_image_ = false;
  std::int64_t cycle_ = -1;
  std::vector<std::int64_t> values_;
  std::vector<char> stale_;

  std::int64_t new_cycle_ = -1;
  std::vector<std::int64_t> new_values_;
  std::vector<char> new_stale_;
  Parts image_parts_;
  std::int64_t strange_cycle_ = 0;  // cycle of the newest image outside the expected range
  int strange_images_ = 0;          // number of such images that followed each other
};

}  // namespace takt
