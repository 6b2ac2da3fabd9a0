#include "master/master_run.hpp"

#include <cassert>
#include <utility>

namespace takt {

std::thread start_plain_thread(std::function<void()> body) { return std::thread{std::move(body)}; }

MasterRun::MasterRun(BusPlan plan, MasterRunOptions options)
    : plan_{std::move(plan)}, options_{options}, exchange_{std::make_unique<Exchange>(plan_)} {}

MasterRun::~MasterRun() {
  request_stop();
  join();
}

std::expected<void, int> MasterRun::start(const StartThread& start_thread) {
  assert(runner_ && !thread_.joinable());
  auto thread = start_thread([this] { run(); });
  if (!thread) return std::unexpected{thread.error()};
  thread_ = std::move(*thread);
  return {};
}

void MasterRun::run() noexcept {
  runner_->start();
  while (!runner_->done()) runner_->cycle();
}

bool MasterRun::cycle() noexcept {
  if (runner_->done()) return false;
  runner_->cycle();
  return !runner_->done();
}

void MasterRun::join() {
  if (thread_.joinable()) thread_.join();
}

bool MasterRun::set(SignalIndex signal, std::int64_t value, std::uint32_t time_to_live) noexcept {
  if (signal < plan_.layout.inputs || signal >= plan_.layout.signals.size()) return false;
  exchange_->set_points.set(signal - plan_.layout.inputs, value, time_to_live);
  return true;
}

}  // namespace takt
