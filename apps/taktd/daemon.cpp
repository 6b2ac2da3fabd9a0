#include "apps/taktd/daemon.hpp"

#include <algorithm>
#include <chrono>
#include <cstdlib>
#include <cstring>
#include <future>
#include <utility>

#include "apps/taktd/bus_choice.hpp"
#include "apps/taktd/summary.hpp"
#include "master/explain/boot_report.hpp"
#include "master/lcm/random_number.hpp"
#include "master/linux/clock.hpp"
#include "master/linux/start_thread.hpp"

namespace takt {
namespace {

constexpr Time patience = std::chrono::seconds{1};  // beyond the limit of the ordered stop
// Time limits for the last writes to the files and to stderr. A stuck disk must not keep the daemon
// from ending.
constexpr Time last_recording = std::chrono::seconds{2};
constexpr Time last_lines = std::chrono::seconds{2};
constexpr std::size_t heap_bytes = 8 << 20;

}  // namespace

Daemon::Daemon(LoadedNetwork network, DaemonOptions options)
    : network_{std::move(network)},
      options_{std::move(options)},
      bus_name_{choose_bus(options_, network_)},
      session_{random_number()},
      wait_{signals_.wait_mask()},
      reporter_{network_.plan},
      recorder_{[this](Weight weight, const std::string& text) { reporter_.say(weight, text); }} {
  if (options_.rt) network_.realtime.mode = *options_.rt;
  if (options_.typed) network_.lcm.typed = *options_.typed;
}

Daemon::~Daemon() {
  StopSignal::stop_with(nullptr);
  reporter_.finish(last_lines);
}

Exit Daemon::run() {
  if (const auto trouble = open()) return *trouble;
  if (const auto trouble = start()) return *trouble;
  loop();
  if (!stopping_ && StopSignal::count() > 0) stop(Exit::good, "a stop was requested");
  if (!master_->finished()) {
    reporter_.say(Weight::error,
                  StopSignal::count() > 1
                      ? "stopped at once: the ordered stop did not bring the axes to rest"
                      : "the ordered stop did not end in time");
    recorder_.finish_running(
        why_.empty() ? "stopped at once" : why_ + "; the ordered stop did not end", last_recording);
    reporter_.finish(last_lines);
    std::_Exit(static_cast<int>(exit_of_cut_stop()));
  }
  master_->join();
  do {
    bridge_->serve();
  } while (bridge_->owes_news());
  judge_stop();
  const bool recorded = recorder_.finish(exit_ == Exit::good ? "" : why_, last_recording);
  reporter_.say(Weight::note, run_summary(*master_, *bridge_, reporter_.told(Weight::error),
                                          reporter_.told(Weight::warning)));
  if (recorded) return exit_;
  reporter_.finish(last_lines);
  std::_Exit(static_cast<int>(exit_));
}

/// Called after the bus thread has ended. Sets the exit code if some axis was not seen at
/// standstill and disabled.
void Daemon::judge_stop() {
  StatusSnapshot snapshot;
  master_->status(snapshot);
  if (snapshot.bus.stop_result != StopResult::unconfirmed) return;
  exit_ = Exit::not_stopped;
  why_ = "the ordered stop was not confirmed" + unconfirmed_;
  reporter_.say(Weight::error, why_);
}

/// Returns the exit code if the daemon ends before the ordered stop has. An axis that is not yet
/// confirmed counts as not stopped.
Exit Daemon::exit_of_cut_stop() const {
  StatusSnapshot snapshot;
  master_->status(snapshot);
  const auto has_axes = [](const NodePlan& node) { return node.cia402; };
  if (!options_.observe && snapshot.bus.stop_result != StopResult::confirmed &&
      std::ranges::any_of(network_.plan.nodes, has_axes)) {
    return Exit::not_stopped;
  }
  return exit_ == Exit::good ? Exit::bus_trouble : exit_;
}

void Daemon::on_refused_envelope(const std::string& sentence) {
  bridge_->tell(Notice{.when = clocks_.now(),
                       .cycle = 0,
                       .node = 0,
                       .kind = "envelope_refused",
                       .weight = Weight::warning,
                       .text = sentence});
}

std::thread Daemon::start_bus_thread(std::function<void()> body) {
  std::promise<RtReport> promise;
  auto report = promise.get_future();
  auto thread = start_thread([options = network_.realtime, body = std::move(body),
                              promise = std::move(promise)]() mutable {
    ::pthread_setname_np(::pthread_self(), "takt-bus");
    const RtReport granted = apply_realtime(options);
    promise.set_value(granted);
    if (granted.may_run()) body();
  });
  if (!thread) {
    reporter_.say(Weight::error,
                  std::string{"the bus thread can't be created: "} + std::strerror(thread.error()));
    return {};
  }
  realtime_ = report.get();
  bus_thread_runs_ = true;
  return std::move(*thread);
}

std::optional<Exit> Daemon::start() {
  prefault_heap(heap_bytes);
  master_ = std::make_unique<Master>(network_.plan, MasterOptions{.observe = options_.observe});
  bus_->attach(*master_, recorder_.journal());
  master_->start([this](std::function<void()> body) { return start_bus_thread(std::move(body)); });
  if (!bus_thread_runs_) return Exit::bus_trouble;
  reporter_.say(realtime_.complete() ? Weight::note : Weight::warning,
                "real time: " + to_string(realtime_));
  if (!realtime_.may_run()) {
    reporter_.say(Weight::error,
                  "--rt enforce: taktd does not start, because the requested real-time settings "
                  "are not available");
    master_->join();
    return Exit::refused;
  }
  reporter_.say(Weight::note, plan_summary(network_) + "  on " + bus_name_ + ", LCM channels " +
                                  Channels{network_.plan.name}.image + " ...");
  Transport& lcm = secured_ ? static_cast<Transport&>(*secured_) : *link_;
  bridge_ = std::make_unique<Bridge>(*master_, lcm, clocks_,
                                     BridgeOptions{.session = session_,
                                                   .observe = options_.observe,
                                                   .interface = bus_name_,
                                                   .realtime = to_string(realtime_),
                                                   .typed = network_.lcm.typed},
                                     [this](const Notice& notice) { on_notice(notice); });
  recorder_.attach(*bridge_);
  if (gateway_) gateway_->attach(*master_, *bridge_);
  StopSignal::stop_with(&master_->stop_requested());
  if (options_.run_for > Time{0}) end_ = clocks_.now() + options_.run_for;
  service_.ready("bus " + network_.plan.name + " on " + bus_name_);
  return std::nullopt;
}

void Daemon::loop() {
  if (network_.realtime.mode != RtMode::off) prefer_this_thread();
  FrontRound round{.next_image = [this] { return master_->next_publish(); },
                   .serve = [this] { return serve(); },
                   .wait = [this](Time next_image, Time latest) { wait(next_image, latest); }};
  signals_.let_through();
  while (!master_->finished() && !gives_up(clocks_.now())) round.run();
}

Time Daemon::serve() {
  const bool image = bridge_->serve();
  if (image) hear_intruders();
  if (gateway_) gateway_->serve();
  const Time now = clocks_.now();
  watch_conditions(now);
  recorder_.serve(now);
  return std::min(bridge_->next_message(), end_);
}

void Daemon::wait(Time next_image, Time latest) {
  if (gives_up(clocks_.now())) return;
  descriptors_.clear();
  link_->watch(descriptors_);
  if (gateway_) gateway_->watch(descriptors_);
  wait_.wait(descriptors_, next_image, latest);
}

/// Returns true if the daemon no longer waits for the end of the ordered stop.
bool Daemon::gives_up(Time now) const {
  return StopSignal::count() > 1 || (stopping_ && now > stop_limit_);
}

void Daemon::hear_intruders() {
  DiagnosticSocket* const ear = bus_->diagnostics();
  if (ear == nullptr || options_.observe) return;
  ear->poll();
  Event event;
  while (ear->take(event)) bridge_->tell(event);
}

void Daemon::watch_conditions(Time now) {
  const BusStatus& bus = bridge_->status().bus;
  if (now - bus.when < std::chrono::seconds{1}) service_.alive(now);
  if (stopping_) return;
  if (StopSignal::count() > 0) return stop(Exit::good, "a stop was requested");
  if (now >= end_) return end_of_time();
  watch_lateness();
}

/// Ends the run of --for. The result is good unless a mandatory node that the master boots has
/// never been ready.
void Daemon::end_of_time() {
  const std::string why = "the time of --for is over";
  const std::string missing = options_.observe ? "" : never_ready();
  if (missing.empty()) return stop(Exit::good, why);
  stop(Exit::node_missing, why + ", and these mandatory nodes were never ready: " + missing);
}

std::string Daemon::never_ready() const {
  std::string names;
  const std::vector<NodeStatus>& statuses = bridge_->status().nodes;
  for (std::size_t i = 0; i < statuses.size(); ++i) {
    const NodePlan& node = network_.plan.nodes[i];
    if (!node.mandatory || !node.boot || statuses[i].boot_count != 0) continue;
    names += (names.empty() ? "" : ", ") + std::to_string(node.id.value()) + " " + node.name;
  }
  return names;
}

void Daemon::watch_lateness() {
  const Time limit = network_.realtime.late_limit;
  if (network_.realtime.mode != RtMode::enforce || limit == Time{0}) return;
  const Time latest = master_->timing().sync_lateness.snapshot().maximum();
  if (latest <= limit) return;
  using std::chrono::microseconds;
  stop(Exit::too_late,
       "SYNC was up to " +
           std::to_string(std::chrono::duration_cast<microseconds>(latest).count()) +
           " us late, but the limit is " +
           std::to_string(std::chrono::duration_cast<microseconds>(limit).count()) + " us");
}

/// Ends the run if the boot of a mandatory node fails before the node was ever ready, and the next
/// try will not ask the node in another way. A node that was ready before is booted again by its
/// plan, while the other nodes go on.
void Daemon::on_notice(const Notice& notice) {
  reporter_.tell(notice);
  recorder_.on_fault(notice);
  if (notice.kind == name(EventKind::stopping)) unconfirmed_.clear();
  if (notice.kind == name(EventKind::axis_not_stopped)) {
    unconfirmed_ += (unconfirmed_.empty() ? ": " : "; ") + notice.text;
  }
  if (notice.kind == name(EventKind::boot_done)) once_ready_.set(notice.node);
  const bool failed = notice.kind == name(EventKind::boot_failed) && !notice.asks_on;
  if (!failed || once_ready_[notice.node]) return;
  for (const NodePlan& node : network_.plan.nodes) {
    if (node.id.value() == notice.node && node.mandatory) {
      stop(Exit::node_missing, "node " + std::to_string(notice.node) + " (" + node.name +
                                   ") is mandatory and did not boot");
    }
  }
}

void Daemon::stop(Exit reason, const std::string& why) {
  if (stopping_) return;
  stopping_ = true;
  exit_ = reason;
  why_ = why;
  stop_limit_ = clocks_.now() + network_.plan.stop_timeout + patience;
  reporter_.say(reason == Exit::good ? Weight::note : Weight::error,
                why + "; the ordered stop begins");
  service_.stopping(network_.plan.stop_timeout + patience + last_recording + last_lines);
  master_->request_stop();
}

}  // namespace takt
