#include "apps/taktd/daemon.hpp"

#include <algorithm>
#include <cerrno>
#include <cstdlib>
#include <cstring>
#include <utility>

#include "apps/taktd/process/time_limits.hpp"
#include "master/gateway/front_round.hpp"
#include "master/linux/rt_thread.hpp"
#include "master/linux/transient_error.hpp"

namespace takt {
namespace {

/// Age of the newest status of a bus thread up to which that thread counts as running.
constexpr Time longest_silence = std::chrono::seconds{1};

}  // namespace

Daemon::Daemon(std::vector<LoadedNetwork> networks, DaemonOptions options)
    : options_{std::move(options)}, wait_{signals_.wait_mask()} {
  const FrontThread front{options_, clocks_, wait_, service_, reporter_};
  for (LoadedNetwork& network : networks) {
    buses_.push_back(std::make_unique<BusRun>(std::move(network), front));
  }
}

Daemon::~Daemon() {
  StopSignal::forget_stops();
  reporter_.finish(last_lines);
}

Exit Daemon::run() {
  if (const auto failure = open()) return *failure;
  if (const auto failure = start()) return *failure;
  loop();
  if (StopSignal::count() > 0) stop(Exit::good, "a stop was requested");
  if (!finished()) {
    for (const auto& bus : buses_) {
      if (!bus->finished()) bus->cut_short(StopSignal::count() > 1);
    }
    leave();
  }
  bool recorded = true;
  for (const auto& bus : buses_) recorded = bus->complete() && recorded;
  if (!recorded) leave();
  return result();
}

std::optional<Exit> Daemon::open() {
  for (const auto& bus : buses_) {
    if (const auto failure = bus->claim()) return failure;
  }
  if (const auto failure = open_events()) return failure;
  for (const auto& bus : buses_) {
    if (const auto failure = bus->open()) return failure;
  }
  return std::nullopt;
}

std::optional<Exit> Daemon::open_events() {
  if (options_.events_file.empty() || reporter_.open_events(options_.events_file)) {
    return std::nullopt;
  }
  const bool passing = is_transient_error(errno);
  reporter_.say(passing ? Weight::warning : Weight::error,
                "--events " + options_.events_file + ": can't be written: " + std::strerror(errno) +
                    (passing ? "; taktd runs without this file" : ""));
  if (passing) return std::nullopt;
  return Exit::wrong_use;
}

std::optional<Exit> Daemon::start() {
  for (const auto& bus : buses_) {
    if (const auto failure = bus->start()) return failure;
    StopSignal::stop_with(bus->stop_requested());
  }
  if (options_.run_for > Time{0}) end_ = clocks_.now() + options_.run_for;
  std::string title;
  for (const auto& bus : buses_) title += (title.empty() ? "" : ", ") + bus->title();
  service_.ready(title);
  return std::nullopt;
}

void Daemon::loop() {
  if (std::ranges::any_of(buses_, &BusRun::wants_realtime)) prefer_this_thread();
  FrontRound round{.next_image = [this] { return next_image(); },
                   .serve = [this] { return serve(); },
                   .wait = [this](Time next_image, Time latest) { wait(next_image, latest); }};
  signals_.let_through();
  while (!finished() && !gives_up(clocks_.now())) round.run();
}

Time Daemon::next_image() const noexcept {
  Time next = never;
  for (const auto& bus : buses_) next = std::min(next, bus->next_image());
  return next;
}

Time Daemon::serve() {
  if (StopSignal::take_recording_request()) {
    for (const auto& bus : buses_) bus->record("requested by SIGUSR1");
  }
  Time latest = end_;
  for (const auto& bus : buses_) latest = std::min(latest, bus->serve());
  watch_conditions(clocks_.now());
  return latest;
}

void Daemon::wait(Time next_image, Time latest) {
  if (gives_up(clocks_.now())) return;
  descriptors_.clear();
  for (const auto& bus : buses_) bus->watch(descriptors_);
  wait_.wait(descriptors_, next_image, latest);
}

bool Daemon::finished() const noexcept { return std::ranges::all_of(buses_, &BusRun::finished); }

/// Returns true if the daemon no longer waits for the end of the ordered stop.
bool Daemon::gives_up(Time now) const {
  return StopSignal::count() > 1 ||
         std::ranges::any_of(buses_, [now](const auto& bus) { return bus->overdue(now); });
}

/// Stops all buses if one bus stops because it lacks a mandatory node or is too late.
void Daemon::watch_conditions(Time now) {
  const auto works = [now](const auto& bus) { return now - bus->alive() < longest_silence; };
  if (std::ranges::all_of(buses_, works)) service_.alive(now);
  if (std::ranges::any_of(buses_, &BusRun::stopping)) return stop(Exit::good, "another bus stops");
  if (StopSignal::count() > 0) return stop(Exit::good, "a stop was requested");
  if (now < end_) return;
  for (const auto& bus : buses_) bus->end_of_time();
}

void Daemon::stop(Exit reason, const std::string& why) {
  for (const auto& bus : buses_) bus->stop(reason, why);
}

/// The exit code of an ordered stop that was not confirmed overrides all others. Otherwise the
/// first bus that did not end well determines the exit code.
Exit Daemon::result() const noexcept {
  Exit result = Exit::good;
  for (const auto& bus : buses_) {
    if (bus->result() == Exit::not_stopped) return Exit::not_stopped;
    if (result == Exit::good) result = bus->result();
  }
  return result;
}

/// Ends the process although one of its threads still works.
void Daemon::leave() {
  reporter_.finish(last_lines);
  std::_Exit(static_cast<int>(result()));
}

}  // namespace takt
