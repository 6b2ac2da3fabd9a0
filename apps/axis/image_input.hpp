#pragma once
#include <cstdint>
#include <takt/image_t.hpp>
#include <takt/layout_t.hpp>
#include <vector>

namespace takt {

/// What has come over LCM, put together from its parts: the layout, and the newest image that is
/// whole. Parts that do not belong together (another session, layout or cycle) are left out. An
/// image whose cycle is older, or more than a second ahead, counts when two more have followed it:
/// a single forged or late one changes nothing. Another layout, or that of another session, counts
/// only when no image of the session before has come for `quiet_ns` (20 periods where that is
/// more).
class ImageInput {
 public:
  static constexpr std::int64_t quiet_ns = 200'000'000;

  /// The time of what is taken from now on, by a clock that never goes back.
  void set_time(std::int64_t now_ns) noexcept { now_ns_ = now_ns; }
  /// True: with this part a layout is complete that differs from the one before.
  bool take(const layout_t& part);
  /// True: with this part a newer image is complete.
  bool take(const image_t& part);

  bool has_layout() const noexcept { return !signals_.empty(); }
  bool has_image() const noexcept { return has_image_; }
  const std::vector<signal_t>& signals() const noexcept { return signals_; }
  std::int64_t session() const noexcept { return session_; }
  std::int64_t period_ns() const noexcept { return period_ns_; }
  std::int64_t cycle() const noexcept { return cycle_; }
  const std::vector<std::int64_t>& values() const noexcept { return values_; }
  bool stale(std::size_t signal) const noexcept { return stale_[signal] != 0; }

 private:
  /// Which parts of something have arrived.
  struct Parts {
    std::vector<char> seen;
    std::size_t missing = 0;
    void restart(std::size_t count);
    bool mark(std::size_t part);  // false: it was there already
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
  std::int64_t image_ns_ = 0;  // when the newest image came

  bool has_image_ = false;
  std::int64_t cycle_ = -1;
  std::vector<std::int64_t> values_;
  std::vector<char> stale_;

  std::int64_t new_cycle_ = -1;
  std::vector<std::int64_t> new_values_;
  std::vector<char> new_stale_;
  Parts image_parts_;
  std::int64_t strange_cycle_ = 0;  // of the newest image that did not follow
  int strange_images_ = 0;          // that followed each other
};

}  // namespace takt
