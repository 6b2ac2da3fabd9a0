#include "master/master_run.hpp"

#include <algorithm>
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

void MasterRun::start(const StartThread& start_thread) {
  assert(runner_ && !thread_.joinable());
  thread_ = start_thread([this] { run(); });
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

bool MasterRun::set_group(std::span<const Command> commands, Time now,
                          std::uint32_t time_to_live) noexcept {
  const auto is_output = [&](const Command& command) {
    return command.signal >= plan_.layout.inputs && command.signal < plan_.layout.signals.size();
  };
  if (!std::ranges::all_of(commands, is_output)) return false;
  for (const Command& command : commands) set(command.signal, command.value, time_to_live);
  publish_outputs(now);
  return true;
}

bool MasterRun::set(SignalIndex signal, std::int64_t value, std::uint32_t time_to_live) noexcept {
  if (signal < plan_.layout.inputs || signal >= plan_.layout.signals.size()) return false;
  exchange_->set_points.set(signal - plan_.layout.inputs, value, time_to_live);
  return true;
}

}  // namespace takt
