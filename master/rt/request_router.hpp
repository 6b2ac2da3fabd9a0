#pragma once
#include "master/core/pdo/fallback_writer.hpp"
#include "master/core/pdo/pdo_requests.hpp"
#include "master/core/request.hpp"
#include "master/rt/exchange/front_link.hpp"
#include "master/rt/machines/bus_machines.hpp"
#include "master/rt/port.hpp"
#include "master/rt/stop/axis_stops.hpp"

namespace takt {

/// Routes the requests of the front thread to the machine that serves them, and each reply to its
/// requester: the front thread, or a part of the loop. Bus thread only.
template <Port P, FrontLink L, Services S>
class RequestRouter {
 public:
  /// Keeps references to all arguments.
  RequestRouter(P& port, L& front, BusMachines<S>& bus, AxisStops<S>& stops) noexcept
      : port_{port}, front_{front}, bus_{bus}, stops_{stops} {}

  /// Takes the next request, unless a reply still waits for room.
  void take_request() noexcept {
    if (reply_waits_ || !front_.take_request(request_)) return;
    if (!bus_.observe && submit()) return;
    reply_ = Reply{.id = request_.id, .fault = SdoFault::cancelled};
    reply_waits_ = true;
  }
  /// Gives all replies, as far as the front thread has room for them.
  void give_replies() noexcept {
    for (;;) {
      if (!reply_waits_ && !bus_.services.take(reply_) && !bus_.pdo_requests.take(reply_)) return;
      if (FallbackWriter::owns(reply_)) continue;
      if (StopRequests::owns(reply_)) {
        stops_.take(reply_, port_.now());
        continue;
      }
      reply_waits_ = !front_.give_reply(reply_);
      if (reply_waits_) return;
    }
  }
  /// Returns true if no reply waits for room.
  bool idle() const noexcept { return !reply_waits_; }

 private:
  bool submit() noexcept {
    const Time now = port_.now();
    stops_.memories().note(request_);
    // An ordered stop commands the nodes itself.
    if (stops_.stopping() && request_.kind == RequestKind::nmt) return false;
    if (!PdoRequests::takes(request_.kind)) return bus_.services.submit(request_, now);
    return !stops_.stopping() && bus_.pdo_requests.submit(request_, now);
  }

  P& port_;
  L& front_;
  BusMachines<S>& bus_;
  AxisStops<S>& stops_;
  Request request_;
  Reply reply_;
  bool reply_waits_ = false;
};

}  // namespace takt
