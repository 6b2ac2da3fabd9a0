#include "apps/master/master_state.hpp"

#include <algorithm>
#include <chrono>
#include <cstring>
#include <utility>

#include "master/linux/bus_name.hpp"
#include "master/linux/clock.hpp"
#include "master/linux/rt_thread.hpp"

namespace takt {
namespace {

/// Period in which the program polls for an image that is later than predicted.
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

std::unexpected<std::string> no_thread(int error) {
  return std::unexpected{std::string{"the bus thread can't be created: "} + std::strerror(error)};
}

}  // namespace

Master::State::State(NetworkFile file, const LoadedNetwork& loaded_file,
                     MasterOptions master_options)
    : network{std::move(file)},
      loaded{loaded_file},
      options{std::move(master_options)},
      units{units_of(loaded.plan)},
      virtual_time{options.bus == virtual_bus
                       ? std::make_unique<VirtualTime>(loaded.devices, loaded.plan)
                       : nullptr},
      run{loaded.plan, {.observe = options.observe, .controller = virtual_time.get()}},
      values(loaded.plan.layout.signals.size()),
      stale(loaded.plan.layout.signals.size() / 64 + 1) {}

std::expected<void, std::string> Master::State::start() {
  if (virtual_time) return start_in_virtual_time();
  const std::string& name = options.bus.empty() ? loaded.plan.interface : options.bus;
  if (!name.empty()) return start_in_real_time(name);
  return std::unexpected{std::string{
      "no bus: neither MasterOptions::bus nor `interface:` of the network file names one"}};
}

std::expected<void, std::string> Master::State::start_in_real_time(const std::string& name) {
  if (!options.observe) {
    auto taken = BusClaim::take(BusName::parse(name));
    if (!taken) return std::unexpected{taken.error().message};
    claim.emplace(std::move(*taken));
  }
  auto opened = OpenedBus::open(name, loaded.plan, loaded.devices, loaded.realtime.spin);
  if (!opened) return std::unexpected{opened.error().message};
  bus = std::move(*opened);
  bus->attach(run, nullptr);
  RtReport granted;
  const auto runs = run.start([&](std::function<void()> body) {
    return start_rt_thread(loaded.realtime, "takt-bus", granted, std::move(body));
  });
  if (!runs) return no_thread(runs.error());
  realtime = to_string(granted);
  if (!granted.may_run()) {
    run.join();
    return std::unexpected{"the requested real-time settings are not available: " + realtime};
  }
  started = true;
  return {};
}

std::expected<void, std::string> Master::State::start_in_virtual_time() {
  virtual_time->attach(run);
  const auto runs = run.start(
      [this](std::function<void()> body) { return virtual_time->start(std::move(body)); });
  if (!runs) return no_thread(runs.error());
  realtime = "virtual time";
  started = true;
  return {};
}

Time Master::State::now() const noexcept {
  return virtual_time ? virtual_time->now() : monotonic_now();
}

bool Master::State::wait(Time longest) {
  if (virtual_time) return virtual_time->next() && take_image();
  const Time begin = monotonic_now();
  return wait_for_image(longest < Time::max() - begin ? begin + longest : Time::max());
}

bool Master::State::wait_for_image(Time until) {
  while (true) {
    const Time next = run.next_publish();
    const bool over = run.finished();
    if (take_image()) return true;
    const Time time = monotonic_now();
    if (over || time >= until) return false;
    sleep_until(std::min(until, std::max(next, time + look)));
  }
}

bool Master::State::take_image() {
  ImageView image;
  if (!run.take_newest(image)) return false;
  cycle = image.cycle;
  sync_time = image.sync_time;
  std::ranges::copy(image.values, values.begin());
  std::ranges::copy(image.stale_bits, stale.begin());
  return true;
}

bool Master::State::stop() {
  if (!started) return false;
  run.request_stop();
  if (virtual_time) {
    while (virtual_time->next()) take_image();
  } else {
    while (!run.finished()) wait(std::chrono::milliseconds{10});
  }
  run.join();
  StatusSnapshot snapshot;
  run.status(snapshot);
  return snapshot.bus.stop_result != StopResult::unconfirmed;
}

std::optional<RequestId> Master::State::submit(Request& request) {
  request.id = newest_request + 1;
  if (!run.submit(request)) return std::nullopt;
  return ++newest_request;
}

bool Master::State::is_output(std::size_t signal) const noexcept {
  return signal >= loaded.plan.layout.inputs && signal < loaded.plan.layout.signals.size();
}

}  // namespace takt
