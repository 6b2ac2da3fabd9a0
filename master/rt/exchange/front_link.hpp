#pragma once
#include <concepts>
#include <cstddef>
#include <cstdint>

#include "master/core/event.hpp"
#include "master/core/request.hpp"
#include "master/rt/exchange/exchange.hpp"
#include "master/rt/exchange/set_points.hpp"

namespace takt {

/// The front thread as the bus loop sees it: the inputs that the loop takes from it, and the
/// replies and events that the loop gives to it. `Port` and this link are the only inputs of the
/// loop, so a recording of both determines what the loop does. A link is a handle that the loop
/// copies. No function allocates, locks or throws.
template <class L>
concept FrontLink = std::copy_constructible<L> &&
                    requires(L link, const L constant, std::uint64_t cycle, Request& request,
                             motion::MotionMessage& motion, const Reply& reply, const Event& event,
                             std::size_t words) {
                      /// Returns the exchange, to which images, states and times go directly.
                      { link.exchange() } noexcept -> std::same_as<Exchange&>;
                      /// Returns the newest set of commands; it is valid until the next call.
                      { link.set_points() } noexcept -> std::same_as<const SetPointFrame&>;
                      { link.take_request(request) } noexcept -> std::same_as<bool>;
                      { link.take_motion(motion) } noexcept -> std::same_as<bool>;
                      { link.stop_requested() } noexcept -> std::same_as<bool>;
                      /// Returns false if there is no room; the loop then offers the reply again.
                      { link.give_reply(reply) } noexcept -> std::same_as<bool>;
                      { link.announce(event) } noexcept;

                      /// Reports that a cycle begins. A recording can begin here.
                      { link.begin_cycle(cycle) } noexcept;
                      /// Returns true if the link needs the state of the loop, so that a replay can
                      /// begin in the middle of a run.
                      { constant.checkpoint_due() } noexcept -> std::same_as<bool>;
                      /// Returns room for the state, or nullptr if it is too long.
                      { link.checkpoint(words) } noexcept -> std::same_as<std::uint64_t*>;
                    };

/// The link to the front thread of this process, without a recording.
class DirectLink {
 public:
  /// Keeps a reference to `exchange`. A loop that is given an exchange makes this link of it.
  DirectLink(Exchange& exchange) noexcept : exchange_{&exchange} {}

  Exchange& exchange() noexcept { return *exchange_; }
  const SetPointFrame& set_points() noexcept { return exchange_->set_points.newest(); }
  bool take_request(Request& request) noexcept { return exchange_->requests.pop(request); }
  bool take_motion(motion::MotionMessage& message) noexcept {
    return exchange_->motions.pop(message);
  }
  bool stop_requested() noexcept {
    return exchange_->stop_requested.load(std::memory_order_relaxed);
  }
  bool give_reply(const Reply& reply) noexcept {
    return !exchange_->replies.full() && exchange_->replies.push(reply);
  }
  void announce(const Event& event) noexcept { exchange_->events.push(event); }

  void begin_cycle(std::uint64_t) noexcept {}
  static constexpr bool checkpoint_due() noexcept { return false; }
  static constexpr std::uint64_t* checkpoint(std::size_t) noexcept { return nullptr; }

 private:
  Exchange* exchange_;
};
static_assert(FrontLink<DirectLink>);

}  // namespace takt
