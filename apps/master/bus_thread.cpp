#include "apps/master/bus_thread.hpp"

#include <future>
#include <pthread.h>
#include <utility>

#include "master/linux/start_thread.hpp"

namespace takt {

std::expected<BusThread, int> start_bus_thread(const RealtimeOptions& options,
                                               std::function<void()> body) {
  std::promise<RtReport> promise;
  auto report = promise.get_future();
  auto thread =
      start_thread([options, body = std::move(body), promise = std::move(promise)]() mutable {
        ::pthread_setname_np(::pthread_self(), "takt-bus");
        const RtReport granted = apply_realtime(options);
        promise.set_value(granted);
        if (granted.may_run()) body();
      });
  if (!thread) return std::unexpected{thread.error()};
  return BusThread{.thread = std::move(*thread), .report = report.get()};
}

}  // namespace takt
