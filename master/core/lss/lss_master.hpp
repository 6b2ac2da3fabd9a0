#pragma once
#include <array>
#include <cstdint>
#include <optional>

#include "master/core/lss/lss_command.hpp"
#include "master/core/lss/lss_scan.hpp"
#include "master/core/machine.hpp"

namespace takt {

/// The LSS master: runs one service at a time, each with a deadline. If several devices may answer,
/// it waits for the full time-out. Within a scan it shortens the waits to what the devices need,
/// and goes back to the full time-out after a doubtful reaction. Bus thread only. CiA 305.
///
/// | phase             | event                         | next phase    | sent       |
/// | ----------------- | ----------------------------- | ------------- | ---------- |
/// | idle              | begin()                       | sending       |            |
/// | sending           | gap is over                   | sending       | next frame |
/// | sending           | last frame was sent           | waiting, over |            |
/// | waiting           | first answer, others may come | answered      |            |
/// | waiting           | the only answer               | over          |            |
/// | waiting, answered | time is over                  | over          |            |
/// | waiting, answered | time is over, scan goes on    | sending       |            |
/// | over              | take_result()                 | idle          |            |
/// | any               | cancel()                      | idle          |            |
class LssMaster {
 public:
  /// Minimum time between two frames of the master.
  static constexpr Time gap = std::chrono::milliseconds{1};

  /// Begins a service; the master must be idle. `timeout` applies to each answer; 0 means the
  /// default of the service.
  void begin(const LssCommand& command, Time timeout, Time now) noexcept;
  /// Takes a frame. Only answers that the running service expects are used.
  void on_frame(const Frame& frame, Time now, Outbox& out) noexcept;
  /// Handles time-outs and sends at most one frame.
  void on_time(Time now, Outbox& out) noexcept;
  Time deadline() const noexcept;
  /// Returns the result once, when the service is over.
  std::optional<LssResult> take_result() noexcept;
  /// Cancels the service; it gives no result.
  void cancel() noexcept { phase_ = Phase::idle; }
  bool idle() const noexcept { return phase_ == Phase::idle; }
  /// Returns true if the newest fast scan may have brought a device into configuration state,
  /// whatever its outcome.
  bool scan_may_have_switched() const noexcept { return fast_.may_have_switched(); }

 private:
  enum class Phase : std::uint8_t {
    idle,
    sending,
    waiting,   ///< No device has answered.
    answered,  ///< Some device has answered, and others may still do so.
    over,
  };
  enum class Wait : std::uint8_t { none, first_answer, all_answers };
  /// The time for which a scan waits for answers: only as long as the devices need (`quick`), or
  /// for the full time-out (`full_timeout`).
  enum class Pace : std::uint8_t { quick, full_timeout };

  void ask() noexcept;
  void ask_scan() noexcept;
  void put(const Frame& frame) noexcept { frames_[count_++] = frame; }
  void sent_all(Time now) noexcept;
  void on_reaction(bool answered, Time now) noexcept;
  void on_scan_reaction(bool answered) noexcept;
  void end_scan(LssScanState state, const LssAddress& address) noexcept;
  void finish(LssOutcome outcome) noexcept;
  bool awaits_answers() const noexcept {
    return phase_ == Phase::waiting || phase_ == Phase::answered;
  }
  void begin_slow_scan() noexcept;
  bool expects(const lss::Answer& answer) const noexcept;
  bool scans() const noexcept {
    return command_.op == LssOp::fast_scan || command_.op == LssOp::slow_scan;
  }
  Time wait() const noexcept;

  LssCommand command_;
  LssResult result_;
  LssFastScan fast_;
  LssSlowScan slow_;
  Phase phase_ = Phase::idle;
  Wait wait_for_ = Wait::none;
  std::array<Frame, 6> frames_{};  // frames of the current question
  std::uint8_t count_ = 0;
  std::uint8_t next_ = 0;
  Pace pace_ = Pace::quick;  // pace of a slow scan
  Time timeout_{};
  Time send_at_{};
  Time asked_at_{};
  Time wait_until_ = never;
  Time slowest_{};  // the slowest answer of this scan
};
static_assert(Machine<LssMaster>);

}  // namespace takt
