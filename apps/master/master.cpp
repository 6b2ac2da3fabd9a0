#include <algorithm>
#include <takt/master.hpp>
#include <utility>

#include "apps/master/master_state.hpp"

namespace takt {

std::expected<Master, std::string> Master::start(NetworkFile network, MasterOptions options) {
  if (!network.usable()) {
    const auto& findings = network.findings();
    const auto error = std::ranges::find(findings, true, &NetworkFinding::error);
    return std::unexpected{error->text};
  }
  const LoadedNetwork& loaded = network.state_->loaded;
  auto state = std::make_unique<State>(std::move(network), loaded, std::move(options));
  if (auto started = state->start(); !started) return std::unexpected{started.error()};
  return Master{std::move(state)};
}

Master::Master(std::unique_ptr<State> state) noexcept : state_{std::move(state)} {}
Master::~Master() = default;
Master::Master(Master&& other) noexcept = default;
Master& Master::operator=(Master&& other) noexcept = default;

const NetworkFile& Master::network() const noexcept { return state_->network; }
const std::string& Master::realtime() const noexcept { return state_->realtime; }
std::chrono::nanoseconds Master::now() const noexcept { return state_->now(); }

bool Master::wait(std::chrono::nanoseconds longest) { return state_->wait(longest); }
std::uint64_t Master::cycle() const noexcept { return state_->cycle; }
std::chrono::nanoseconds Master::sync_time() const noexcept { return state_->sync_time; }

double Master::value(std::size_t signal) const {
  const ValueFormat& format = state_->units.format(signal);
  return number_of(format.type, state_->values[signal]) * format.scale + format.offset;
}

std::int64_t Master::raw(std::size_t signal) const { return state_->values[signal]; }

bool Master::stale(std::size_t signal) const {
  return ((state_->stale[signal / 64] >> (signal % 64)) & 1) != 0;
}

bool Master::set(std::size_t signal, double value) {
  if (!state_->is_output(signal)) return false;
  const auto raw = state_->units.raw_of(signal, value);
  return raw && set_raw(signal, *raw);
}

bool Master::set_raw(std::size_t signal, std::int64_t value) {
  if (!state_->is_output(signal)) return false;
  const ValueFormat& format = state_->units.format(signal);
  if (!fits(format.type, format.bits, value)) return false;
  return state_->run.set(static_cast<SignalIndex>(signal), value, state_->options.time_to_live);
}

void Master::send() { state_->run.publish_outputs(now()); }

void Master::request_stop() noexcept { state_->run.request_stop(); }
bool Master::stop() { return state_->stop(); }

}  // namespace takt
