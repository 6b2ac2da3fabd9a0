#include "apps/taktd/bus_run.hpp"

#include <algorithm>
#include <chrono>
#include <cstring>
#include <fmt/format.h>
#include <utility>

#include "apps/taktd/bus_choice.hpp"
#include "apps/taktd/process/time_limits.hpp"
#include "apps/taktd/summary.hpp"
#include "master/explain/boot_report.hpp"
#include "master/lcm/random_number.hpp"

namespace takt {
namespace {

constexpr Time stop_margin = std::chrono::seconds{1};  // time beyond the limit of the ordered stop

}  // namespace

BusRun::BusRun(LoadedNetwork network, const FrontThread& front)
    : network_{std::move(network)},
      front_{front},
      bus_name_{choose_bus(front.options, network_)},
      session_{random_number()},
      recorder_{[this](Weight weight, const std::string& text) { say(weight, text); }} {
  if (front.options.rt) network_.realtime.mode = *front.options.rt;
  if (front.options.typed) network_.lcm.typed = *front.options.typed;
}

std::optional<Exit> BusRun::start() {
  const bool observe = front_.options.observe;
  master_ = std::make_unique<MasterRun>(network_.plan, MasterRunOptions{.observe = observe});
  bus_->attach(*master_, recorder_.journal());
  const auto started = master_->start([this](std::function<void()> body) {
    return start_rt_thread(network_.realtime, "takt-bus", realtime_, std::move(body));
  });
  if (!started) {
    say(Weight::error,
        std::string{"the bus thread can't be created: "} + std::strerror(started.error()));
    return Exit::bus_failure;
  }
  say(realtime_.complete() ? Weight::note : Weight::warning, "real time: " + to_string(realtime_));
  if (!realtime_.may_run()) {
    master_->join();
    return refuse(Exit::refused,
                  "--rt enforce: taktd does not start, because the requested real-time settings "
                  "are not available");
  }
  say(Weight::note, plan_summary(network_) + "  on " + bus_name_ + ", LCM channels " +
                        Channels{network_.plan.name}.image + " ...");
  Transport& lcm = secured_ ? static_cast<Transport&>(*secured_) : *link_;
  bridge_ = std::make_unique<Bridge>(*master_, lcm, front_.clocks,
                                     BridgeOptions{.session = session_,
                                                   .observe = observe,
                                                   .interface = bus_name_,
                                                   .realtime = to_string(realtime_),
                                                   .motions = front_.options.motions,
                                                   .typed = network_.lcm.typed,
                                                   .device_files = network_.device_files},
                                     [this](const Notice& notice) { on_notice(notice); });
  recorder_.attach(*bridge_);
  if (gateway_) gateway_->attach(*master_, *bridge_);
  return std::nullopt;
}

Time BusRun::serve() {
  const bool image = bridge_->serve();
  if (image) hear_intruders();
  if (gateway_) gateway_->serve();
  if (!stopping_) watch_lateness();
  recorder_.serve(front_.clocks.now());
  front_.reporter.settle();
  return bridge_->next_message();
}

void BusRun::watch(std::vector<pollfd>& descriptors) const {
  link_->watch(descriptors);
  if (gateway_) gateway_->watch(descriptors);
}

void BusRun::hear_intruders() {
  DiagnosticSocket* const listener = bus_->diagnostics();
  if (listener == nullptr || front_.options.observe) return;
  listener->poll();
  Event event;
  while (listener->take(event)) bridge_->announce(event);
}

void BusRun::watch_lateness() {
  const Time limit = network_.realtime.late_limit;
  if (network_.realtime.mode != RtMode::enforce || limit == Time{0}) return;
  const Time latest = master_->timing().sync_lateness.snapshot().maximum();
  if (latest <= limit) return;
  using namespace std::chrono_literals;
  stop(Exit::too_late,
       fmt::format("SYNC was up to {} us late, but the limit is {} us", latest / 1us, limit / 1us));
}

/// Ends the run if the boot of a mandatory node fails before the node was ever ready. The run
/// continues if the next boot attempt probes the node in another way (Notice::asks_on). A node that
/// was ready before is booted again by its plan, while the other nodes continue.
void BusRun::on_notice(const Notice& notice) {
  front_.reporter.announce(network_.plan, notice);
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
      stop(Exit::node_missing,
           fmt::format("node {} ({}) is mandatory and did not boot", notice.node, node.name));
    }
  }
}

void BusRun::on_refused_envelope(const std::string& sentence) {
  bridge_->announce(Notice{.when = front_.clocks.now(),
                           .cycle = 0,
                           .node = 0,
                           .kind = "envelope_refused",
                           .weight = Weight::warning,
                           .text = sentence});
}

void BusRun::stop(Exit reason, const std::string& why) {
  if (stopping_) return;
  const Time limit = network_.plan.stop_timeout + stop_margin;
  stopping_ = true;
  exit_ = reason;
  why_ = why;
  stop_limit_ = front_.clocks.now() + limit;
  say(reason == Exit::good ? Weight::note : Weight::error, why + "; the ordered stop begins");
  front_.service.stopping(limit + last_recording + last_lines);
  master_->request_stop();
}

void BusRun::end_of_time() {
  const std::string why = "the time of --for is over";
  const std::string missing = front_.options.observe ? "" : never_ready();
  if (missing.empty()) return stop(Exit::good, why);
  stop(Exit::node_missing, why + ", and these mandatory nodes were never ready: " + missing);
}

std::string BusRun::never_ready() const {
  std::string names;
  const std::vector<NodeStatus>& statuses = bridge_->status().nodes;
  for (std::size_t i = 0; i < statuses.size(); ++i) {
    const NodePlan& node = network_.plan.nodes[i];
    if (!node.mandatory || !node.boot || statuses[i].boot_count != 0) continue;
    names += fmt::format("{}{} {}", names.empty() ? "" : ", ", node.id.value(), node.name);
  }
  return names;
}

bool BusRun::complete() {
  master_->join();
  do {
    bridge_->serve();
  } while (bridge_->has_unsent_reports());
  judge_stop();
  const bool recorded = recorder_.finish(exit_ == Exit::good ? "" : why_, last_recording);
  front_.reporter.settle();
  say(Weight::note, run_summary(*master_, *bridge_, front_.reporter.reported(Weight::error),
                                front_.reporter.reported(Weight::warning)));
  return recorded;
}

/// Sets the exit code if the ordered stop was not confirmed: at least one axis was not seen at
/// standstill and then disabled.
void BusRun::judge_stop() {
  StatusSnapshot snapshot;
  master_->status(snapshot);
  if (snapshot.bus.stop_result != StopResult::unconfirmed) return;
  exit_ = Exit::not_stopped;
  why_ = "the ordered stop was not confirmed" + unconfirmed_;
  say(Weight::error, why_);
}

void BusRun::cut_short(bool by_signal) {
  say(Weight::error, by_signal ? "stopped at once: the ordered stop did not bring the axes to rest"
                               : "the ordered stop did not end in time");
  recorder_.finish_running(
      why_.empty() ? "stopped at once" : why_ + "; the ordered stop did not end", last_recording);
  exit_ = exit_of_cut_stop();
}

/// An axis that is not yet confirmed counts as not stopped.
Exit BusRun::exit_of_cut_stop() const {
  StatusSnapshot snapshot;
  master_->status(snapshot);
  const auto has_axes = [](const NodePlan& node) { return node.cia402; };
  if (!front_.options.observe && snapshot.bus.stop_result != StopResult::confirmed &&
      std::ranges::any_of(network_.plan.nodes, has_axes)) {
    return Exit::not_stopped;
  }
  return exit_ == Exit::good ? Exit::bus_failure : exit_;
}

}  // namespace takt
