#pragma once
#include <cstddef>
#include <cstdint>
#include <optional>
#include <span>
#include <vector>

#include "master/rt/exchange/front_link.hpp"
#include "master/rt/journal/journal.hpp"
#include "master/rt/journal/journal_motion.hpp"
#include "master/rt/journal/journal_request.hpp"
#include "master/rt/journal/recorded_port.hpp"

namespace takt {

/// A journal in the form of a file. The frames lie in a separate list, ordered by time, and the
/// records refer to them by number:
///   receive: two words for each frame, its time and its number
///   send:    one word for each frame that was sent, its number
///   event:   no words; the file keeps the events separately as well
/// All other records have the form that Mark describes.
struct Recording {
  std::vector<std::uint64_t> words{};
  std::vector<Frame> frames{};
};

/// The first point at which the master acts differently than in the recording.
struct ReplayDifference {
  enum class What : std::uint8_t {
    call,     ///< the master makes another call to its bus or its clock
    frame,    ///< the master sends another frame
    count,    ///< the master sends more or fewer frames at once
    cycle,    ///< the master is in another cycle
    broken,   ///< the recording itself is invalid at this point
    missing,  ///< an item was too long to be recorded
  };
  What what = What::call;
  std::uint64_t cycle = 0;
  Time when{};
  Mark recorded{};  ///< call: the next call in the recording
  Mark asked{};     ///< call: the call that the master made
  Frame sent{};     ///< frame: the frame sent now; `expected` is the recorded one
  Frame expected{};
  std::size_t line = 0;  ///< frame: number of the expected frame, from 0
  std::size_t part = 0;  ///< index of the recording among those that follow one another
  std::uint64_t counted = 0;
  std::uint64_t counted_before = 0;
};

/// Plays a recording to a bus loop and answers each call as it was answered then. From the first
/// difference on, the port gives no more input; only its clock advances, so that the cycle can end.
/// Arbitrary words in the recording are safe.
class ReplayPort {
 public:
  /// Keeps references to the recordings, which follow one another in time. `outputs` is the number
  /// of outputs in the replayed plan.
  ReplayPort(std::span<const Recording> parts, std::size_t outputs);

  /// Returns true if the recordings are played to the end, or if a difference was found.
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
  PortCondition condition() const noexcept;

  // These functions return the recorded input of the front thread, for ReplayedLink.
  void begin_cycle(std::uint64_t cycle) noexcept;
  const SetPointFrame& set_points() noexcept;
  bool take_request(Request& request) noexcept;
  bool take_motion(motion::MotionMessage& message) noexcept;
  bool stop_requested() noexcept;
  bool give_reply() noexcept;
  void note_event() noexcept;

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
  // Reading the condition does not change a port, but advances the recording. It is therefore
  // `mutable`.
  mutable std::size_t part_ = 0;
  mutable std::span<const std::uint64_t> words_;
  mutable std::span<const Frame> frames_;
  mutable std::size_t at_ = 0;
  mutable std::optional<ReplayDifference> difference_;
  mutable PortCondition condition_;
  Time now_{};
  std::uint64_t cycle_ = 0;
  SetPointFrame points_;
  SdoTransfers transfers_;
};
static_assert(Port<ReplayPort>);

/// Plays the front thread of the recording that a ReplayPort plays. Events go to the exchange,
/// where the replay compares them.
class ReplayedLink {
 public:
  /// Keeps pointers to both arguments.
  ReplayedLink(ReplayPort& port, Exchange& exchange) noexcept
      : port_{&port}, exchange_{&exchange} {}

  Exchange& exchange() noexcept { return *exchange_; }
  const SetPointFrame& set_points() noexcept { return port_->set_points(); }
  bool take_request(Request& request) noexcept { return port_->take_request(request); }
  bool take_motion(motion::MotionMessage& message) noexcept { return port_->take_motion(message); }
  bool stop_requested() noexcept { return port_->stop_requested(); }
  bool give_reply(const Reply&) noexcept { return port_->give_reply(); }
  void announce(const Event& event) noexcept {
    exchange_->events.push(event);
    port_->note_event();
  }

  void begin_cycle(std::uint64_t cycle) noexcept { port_->begin_cycle(cycle); }
  /// The replay skips the checkpoints of the recording and writes none.
  static constexpr bool checkpoint_due() noexcept { return false; }
  static constexpr std::uint64_t* checkpoint(std::size_t) noexcept { return nullptr; }

 private:
  ReplayPort* port_;
  Exchange* exchange_;
};
static_assert(FrontLink<ReplayedLink>);

}  // namespace takt
