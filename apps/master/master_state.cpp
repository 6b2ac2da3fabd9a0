#include "apps/master/master_state.hpp"

#include <algorithm>
#include <chrono>
#include <cstring>
#include <utility>

#include "apps/master/bus_thread.hpp"
#include "master/linux/bus_name.hpp"
#include "master/linux/clock.hpp"

namespace takt {
namespace {

/// Pause between two looks for an image that is later than predicted.
constexpr Time look = std::chrono::microseconds{200};
constexpr std::string_view virtual_bus = "virtual";

Units units_of(const BusPlan& plan) {
  std::vector<ValueFormat> formats;
  for (const Signal& signal : plan.layout.signals) {
    formats.push_back(
        {.type = signal.type, .bits = signal.bits, .scale = signal.scale, .offset = signal.offset});
  }
  return Units{formats};
}

}  // namespace

Master::State::State(NetworkFile network, const LoadedNetwork& loaded, MasterOptions options)
    : network_{std::move(network)},
      loaded_{loaded},
      options_{std::move(options)},
      units_{units_of(loaded_.plan)},
      virtual_time_{options_.bus == virtual_bus
                        ? std::make_unique<VirtualTime>(loaded_.devices, loaded_.plan)
                        : nullptr},
      run_{loaded_.plan, {.observe = options_.observe, .controller = virtual_time_.get()}},
      values_(loaded_.plan.layout.signals.size()),
      stale_(loaded_.plan.layout.signals.size() / 64 + 1) {}

std::expected<void, std::string> Master::State::start() {
  if (virtual_time_) return start_in_virtual_time();
  const std::string& bus = options_.bus.empty() ? loaded_.plan.interface : options_.bus;
  if (!bus.empty()) return start_in_real_time(bus);
  return std::unexpected{std::string{
      "no bus: neither MasterOptions::bus nor `interface:` of the network file names one"}};
}

std::expected<void, std::string> Master::State::start_in_real_time(const std::string& bus) {
  if (!options_.observe) {
    auto claim = BusClaim::take(BusName::parse(bus));
    if (!claim) return std::unexpected{claim.error().message};
    claim_.emplace(std::move(*claim));
  }
  auto opened = OpenedBus::open(bus, loaded_.plan, loaded_.devices, loaded_.realtime.spin);
  if (!opened) return std::unexpected{opened.error().message};
  bus_ = std::move(*opened);
  bus_->attach(run_, nullptr);
  int error = 0;
  RtReport granted;
  run_.start([&](std::function<void()> body) {
    auto started = start_bus_thread(loaded_.realtime, std::move(body));
    if (started) {
      granted = std::move(started->report);
      return std::move(started->thread);
    }
    error = started.error();
    return std::thread{};
  });
  if (error != 0) {
    return std::unexpected{std::string{"the bus thread can't be created: "} + std::strerror(error)};
  }
  realtime_ = to_string(granted);
  if (!granted.may_run()) {
    run_.join();
    return std::unexpected{"the requested real-time settings are not available: " + realtime_};
  }
  started_ = true;
  return {};
}

std::expected<void, std::string> Master::State::start_in_virtual_time() {
  virtual_time_->attach(run_);
  int error = 0;
  run_.start([&](std::function<void()> body) {
    auto thread = virtual_time_->start(std::move(body));
    if (thread) return std::move(*thread);
    error = thread.error();
    return std::thread{};
  });
  if (error != 0) {
    return std::unexpected{std::string{"the bus thread can't be created: "} + std::strerror(error)};
  }
  realtime_ = "virtual time";
  started_ = true;
  return {};
}

Time Master::State::now() const noexcept {
  return virtual_time_ ? virtual_time_->now() : monotonic_now();
}

bool Master::State::wait(Time longest) {
  if (virtual_time_) return virtual_time_->next() && take_image();
  const Time now = monotonic_now();
  return wait_for_image(longest < Time::max() - now ? now + longest : Time::max());
}

bool Master::State::wait_for_image(Time until) {
  while (true) {
    const Time next = run_.next_publish();
    const bool over = run_.finished();
    if (take_image()) return true;
    const Time now = monotonic_now();
    if (over || now >= until) return false;
    sleep_until(std::min(until, std::max(next, now + look)));
  }
}

bool Master::State::take_image() {
  ImageView image;
  if (!run_.take_newest(image)) return false;
  cycle_ = image.cycle;
  sync_time_ = image.sync_time;
  std::ranges::copy(image.values, values_.begin());
  std::ranges::copy(image.stale_bits, stale_.begin());
  return true;
}

bool Master::State::stop() {
  if (!started_) return false;
  run_.request_stop();
  if (virtual_time_) {
    while (virtual_time_->next()) take_image();
  } else {
    while (!run_.finished()) wait(std::chrono::milliseconds{10});
  }
  run_.join();
  StatusSnapshot snapshot;
  run_.status(snapshot);
  return snapshot.bus.stop_result != StopResult::unconfirmed;
}

double Master::State::value(std::size_t signal) const {
  const ValueFormat& format = units_.format(signal);
  return number_of(format.type, values_[signal]) * format.scale + format.offset;
}

bool Master::State::is_output(std::size_t signal) const noexcept {
  return signal >= loaded_.plan.layout.inputs && signal < loaded_.plan.layout.signals.size();
}

bool Master::State::set(std::size_t signal, double si) {
  if (!is_output(signal)) return false;
  const auto raw = units_.raw_of(signal, si);
  return raw && set_raw(signal, *raw);
}

bool Master::State::set_raw(std::size_t signal, std::int64_t value) {
  if (!is_output(signal)) return false;
  const ValueFormat& format = units_.format(signal);
  if (!fits(format.type, format.bits, value)) return false;
  return run_.set(static_cast<SignalIndex>(signal), value, options_.time_to_live);
}

}  // namespace takt
