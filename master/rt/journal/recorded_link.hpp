#pragma once
#include <cstddef>
#include <cstdint>
#include <cstring>

#include "master/rt/exchange/front_link.hpp"
#include "master/rt/journal/journal.hpp"
#include "master/rt/journal/journal_motion.hpp"
#include "master/rt/journal/journal_request.hpp"

namespace takt {

/// Records what the bus loop takes from the front thread, and the events that it gives. This adds
/// no system call and allocates nothing. Without a journal, the link only forwards. Bus thread
/// only.
class RecordedLink {
 public:
  /// Keeps pointers to `exchange` and `journal`.
  RecordedLink(Exchange& exchange, Journal* journal) noexcept
      : direct_{exchange}, journal_{journal} {}

  Exchange& exchange() noexcept { return direct_.exchange(); }
  const SetPointFrame& set_points() noexcept {
    const SetPointFrame& frame = direct_.set_points();
    if (journal_ != nullptr) note(frame);
    return frame;
  }
  bool take_request(Request& request) noexcept {
    if (!direct_.take_request(request)) return false;
    if (journal_ != nullptr) put_request(*journal_, request, exchange().transfers);
    return true;
  }
  bool take_motion(motion::MotionMessage& message) noexcept {
    if (!direct_.take_motion(message)) return false;
    if (journal_ != nullptr) put_motion(*journal_, message);
    return true;
  }
  bool stop_requested() noexcept {
    if (!direct_.stop_requested()) return false;
    if (journal_ != nullptr) journal_->put(Mark::stop, 0);
    return true;
  }
  bool give_reply(const Reply& reply) noexcept {
    if (direct_.give_reply(reply)) return true;
    if (journal_ != nullptr) journal_->put(Mark::replies_full, 0);
    return false;
  }
  void announce(const Event& event) noexcept {
    direct_.announce(event);
    if (journal_ == nullptr) return;
    std::uint64_t* const room = journal_->claim(Mark::event, 0, journal::event_words);
    if (room != nullptr) std::memcpy(static_cast<void*>(room), &event, sizeof event);
  }

  void begin_cycle(std::uint64_t cycle) noexcept {
    if (journal_ != nullptr) journal_->begin_cycle(cycle);
  }
  bool checkpoint_due() const noexcept { return journal_ != nullptr && journal_->checkpoint_due(); }
  std::uint64_t* checkpoint(std::size_t words) noexcept { return journal_->checkpoint(words); }

 private:
  /// Records the set of commands if it is new. The triple buffer returns another of its frames
  /// whenever it has a new set.
  void note(const SetPointFrame& frame) noexcept {
    const bool unchanged = recorded_ == &frame && beginnings_ == journal_->beginnings();
    if (unchanged || frame.points.empty()) {
      return journal_->put(Mark::set_points, std::uint64_t{0});
    }
    recorded_ = &frame;
    beginnings_ = journal_->beginnings();
    const std::size_t bytes = frame.points.size() * sizeof(SetPoint);
    std::uint64_t* const room =
        journal_->claim(Mark::set_points, frame.points.size(), 1 + bytes / 8);
    if (room == nullptr) return;
    room[0] = static_cast<std::uint64_t>(frame.when.count());
    std::memcpy(static_cast<void*>(room + 1), frame.points.data(), bytes);
  }

  DirectLink direct_;
  Journal* journal_;
  unsigned beginnings_ = 0;
  const SetPointFrame* recorded_ = nullptr;  // the frame that the loop received last
};
static_assert(FrontLink<RecordedLink>);

}  // namespace takt
