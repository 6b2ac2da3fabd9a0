#include "master/master.hpp"

#include <algorithm>
#include <cassert>
#include <utility>

namespace takt {

std::thread start_plain_thread(std::function<void()> body) { return std::thread{std::move(body)}; }

Master::Master(BusPlan plan, MasterOptions options)
    : plan_{std::move(plan)}, options_{options}, exchange_{std::make_unique<Exchange>(plan_)} {}

Master::~Master() {
  request_stop();
  join();
}

void Master::start(const StartThread& start_thread) {
  assert(runner_ && !thread_.joinable());
  thread_ = start_thread([this] { run(); });
}

void Master::run() noexcept {
  runner_->start();
  while (!runner_->done()) runner_->cycle();
}

bool Master::cycle() noexcept {
  if (runner_->done()) return false;
  runner_->cycle();
  return !runner_->done();
}

void Master::join() {
  if (thread_.joinable()) thread_.join();
}

bool Master::set_group(std::span<const Command> commands, Time now,
                       std::uint32_t time_to_live) noexcept {
  const auto is_output = [&](const Command& command) {
    return command.signal >= plan_.layout.inputs && command.signal < plan_.layout.signals.size();
  };
  if (!std::ranges::all_of(commands, is_output)) return false;
  for (const Command& command : commands) set(command.signal, command.value, time_to_live);
  publish_outputs(now);
  return true;
}

bool Master::set(SignalIndex signal, std::int64_t value, std::uint32_t time_to_live) noexcept {
  if (signal < plan_.layout.inputs || signal >= plan_.layout.signals.size()) return false;
  exchange_->set_points.set(signal - plan_.layout.inputs, value, time_to_live);
  return true;
}

}  // namespace takt
