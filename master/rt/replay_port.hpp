#pragma once
#include <cstddef>
#include <cstdint>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "master/rt/exchange.hpp"
#include "master/rt/journal.hpp"
#include "master/rt/journal_request.hpp"
#include "master/rt/recorded_port.hpp"

namespace takt {

/// A journal as it lies in a file: the frames stand beside it, in the order of their times.
///   receive: two words each, time and number of the frame
///   send:    one word each of those that were sent, the number of the frame
///   event:   none; events stand beside it too
/// All other records are as Mark says.
struct Recording {
  std::vector<std::uint64_t> words{};
  std::vector<Frame> frames{};
};

/// Where the master does something else than it did when it was recorded.
struct ReplayDifference {
  enum class What : std::uint8_t {
    call,     ///< it asks its bus or its clock for something else
    frame,    ///< it sends another frame
    count,    ///< it sends more or fewer frames at once
    cycle,    ///< it is in another cycle
    broken,   ///< the recording itself makes no sense here
    missing,  ///< something was too long to be recorded
  };
  What what = What::call;
  std::uint64_t cycle = 0;
  Time when{};
  Mark recorded{};  ///< call: what comes next in the recording
  Mark asked{};     ///< and what the master did
  Frame sent{};     ///< frame: now; `expected` in the recording
  Frame expected{};
  std::size_t line = 0;  ///< frame: number of the expected one, from 0
  std::size_t part = 0;  ///< of the recordings that follow one another
  std::uint64_t counted = 0;
  std::uint64_t counted_before = 0;
};

/// Plays a recording to a bus loop: each call is answered as it was then. From the first difference
/// on nothing comes any more; the clock goes on, so that the cycle can end. Any words are safe.
class ReplayPort {
 public:
  /// Keeps references to the recordings, which follow one another. `outputs` of the plan that is
  /// replayed.
  ReplayPort(std::span<const Recording> parts, std::size_t outputs);

  /// All is played, or nothing fits any more.
  bool over() const noexcept {
    return difference_ || (part_ + 1 >= parts_.size() && at_ == words_.size());
  }
  const std::optional<ReplayDifference>& difference() const noexcept { return difference_; }
  Time time() const noexcept { return now_; }

  Time now() noexcept;
  void sleep_until(Time until) noexcept;
  void sleep_precisely_until(Time until) noexcept { sleep_until(until); }
  bool wait_frame(Time until) noexcept;
  std::size_t receive(std::span<StampedFrame> in) noexcept;
  SendResult send(std::span<const Frame> out) noexcept;
  PortNews news() const noexcept;

  void begin_cycle(std::uint64_t cycle) noexcept;
  /// Those of the recording are passed over.
  bool checkpoint_due() const noexcept { return false; }
  std::uint64_t* checkpoint(std::size_t) noexcept { return nullptr; }
  const SetPointFrame& set_points(Exchange& exchange) noexcept;
  bool take_request(Exchange& exchange, Request& request) noexcept;
  bool stop_requested(Exchange& exchange) noexcept;
  bool give_reply(Exchange& exchange, const Reply& reply) noexcept;
  void tell(Exchange& exchange, const Event& event) noexcept;

 private:
  std::optional<std::uint64_t> next(Mark mark) const noexcept;
  bool comes(Mark mark) const noexcept;
  void pass_checkpoint() const noexcept;
  bool take(std::size_t count, std::span<const std::uint64_t>& words) const noexcept;
  bool take_time(Time& time) const noexcept;
  const Frame* take_frame(std::size_t& number) const noexcept;
  void differ(ReplayDifference difference) const noexcept;

  void begin_part() const noexcept;

  std::span<const Recording> parts_;
  // Reading news is no change of a port, but a step in its recording.
  mutable std::size_t part_ = 0;
  mutable std::span<const std::uint64_t> words_;
  mutable std::span<const Frame> frames_;
  mutable std::size_t at_ = 0;
  mutable std::optional<ReplayDifference> difference_;
  mutable PortNews news_;
  Time now_{};
  std::uint64_t cycle_ = 0;
  SetPointFrame points_;
  SdoTransfers transfers_;
};
static_assert(WitnessPort<ReplayPort>);

}  // namespace takt
