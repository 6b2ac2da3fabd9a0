#pragma once
#include <cstddef>
#include <cstdint>
#include <span>

#include "eds_parser/table/bus_plan.hpp"
#include "master/core/kept_state.hpp"
#include "master/core/network/network.hpp"
#include "master/rt/beat/beat.hpp"
#include "master/rt/controller.hpp"
#include "master/rt/cycle_report.hpp"
#include "master/rt/exchange/front_link.hpp"
#include "master/rt/frame_sender.hpp"
#include "master/rt/image_publisher.hpp"
#include "master/rt/intake.hpp"
#include "master/rt/machines/bus_machines.hpp"
#include "master/rt/machines/services.hpp"
#include "master/rt/motion/motion_stage.hpp"
#include "master/rt/node_exchange.hpp"
#include "master/rt/output_stage.hpp"
#include "master/rt/port.hpp"
#include "master/rt/request_router.hpp"
#include "master/rt/slack.hpp"
#include "master/rt/stop/stop_control.hpp"

namespace takt {

struct BusLoopOptions {
  bool observe = false;              ///< listen only; the loop sends nothing
  Controller* controller = nullptr;  ///< called in each cycle; must outlive the loop
};

/// The bus thread runs one SYNC cycle after another. A complete cycle makes six system calls
/// (sleep, SYNC, sleep, receive, sleep, outputs), a cycle with a missing PDO makes eight; service
/// frames add more. Nothing allocates, locks or throws after construction.
template <Port P, FrontLink L = DirectLink, Services S = Network>
class BusLoop {
 public:
  /// The loop keeps references to `plan` and `port`, and to the exchange of `front`.
  BusLoop(const BusPlan& plan, P& port, L front, BusLoopOptions options = {});
  BusLoop(const BusLoop&) = delete;
  BusLoop& operator=(const BusLoop&) = delete;

  /// The first SYNC goes out one period after this call.
  void start() noexcept;
  /// Replaces start(): continues from a checkpoint that another loop with this plan has written.
  /// Runs the rest of that cycle, which begins after the publication of its image. Returns false if
  /// the checkpoint belongs to another plan or to another version of takt.
  bool resume(std::span<const std::uint64_t> checkpoint) noexcept;
  /// Runs one whole cycle and returns after its outputs have been sent.
  void cycle() noexcept;
  void request_stop() noexcept { front_.exchange().stop_requested = true; }
  /// Returns true once the ordered stop is complete; the caller must not run another cycle.
  bool done() const noexcept { return stop_.done(); }

 private:
  void begin_beat() noexcept;
  bool send_sync() noexcept;
  void publish() noexcept;
  void run_motions() noexcept;
  void use_slack() noexcept;
  void serve_round() noexcept;
  void send_outputs() noexcept;
  void finish_cycle() noexcept;

  // See bus_loop_checkpoint.hpp.
  bool idle() const noexcept;
  void keep_state() noexcept;
  template <class Archive>
  void keep(Archive& state) noexcept;

  P& port_;
  L front_;
  BusMachines<S> bus_;
  Beat beat_;
  FrameSender<P> sender_;
  StopControl<S> stop_;
  NodeExchange<P, L, S> nodes_;
  Intake<P, S> intake_;
  ImagePublisher<S> images_;
  RequestRouter<P, L, S> requests_;
  Slack<P, S> slack_;
  MotionStage<L, S> motions_;
  OutputStage<P, L, S> outputs_;
  CycleReport<L, S> report_;
  Time published_{};             ///< publish time of the newest image
  std::size_t state_words_ = 0;  ///< size of a checkpoint without points of streams
};

template <Port P, FrontLink L, Services S>
BusLoop<P, L, S>::BusLoop(const BusPlan& plan, P& port, L front, BusLoopOptions options)
    : port_{port},
      front_{front},
      bus_{plan, options.observe},
      beat_{plan, bus_.events, bus_.status, front_.exchange().timing},
      sender_{port, beat_, bus_.events, bus_.status},
      stop_{bus_},
      nodes_{port, front_, beat_, bus_, stop_.stops().memories()},
      intake_{port, beat_, bus_, front_.exchange().timing},
      images_{beat_, bus_, front_.exchange(), options.controller},
      requests_{port, front_, bus_, stop_.stops()},
      slack_{port, beat_, sender_, intake_, bus_},
      motions_{front_, bus_},
      outputs_{port, front_, beat_, sender_, bus_},
      report_{front_, beat_, bus_} {
  StateSize size;
  keep(size);
  state_words_ = size.count();
}

template <Port P, FrontLink L, Services S>
void BusLoop<P, L, S>::start() noexcept {
  const Time now = port_.now();
  beat_.start(now);
  bus_.services.start(now);
  images_.predict(now, intake_.predicted());
}

/// One cycle, with the letters of the picture in the README.
template <Port P, FrontLink L, Services S>
void BusLoop<P, L, S>::cycle() noexcept {
  front_.begin_cycle(beat_.cycle());
  nodes_.update(stop_.ordered().axes_done());
  begin_beat();       // A
  intake_.receive();  // B
  publish();          // C
  run_motions();
  keep_state();
  finish_cycle();
}

template <Port P, FrontLink L, Services S>
void BusLoop<P, L, S>::finish_cycle() noexcept {
  use_slack();     // E
  send_outputs();  // D
  report_.end_cycle(stop_.ordered());
  beat_.next();  // F: the bus is quiet until the next SYNC
}

/// Waits until the cycle begins: until the time of SYNC, which this function then sends, or until
/// the SYNC of another device arrives.
template <Port P, FrontLink L, Services S>
void BusLoop<P, L, S>::begin_beat() noexcept {
  beat_.await(port_, bus_.services, [&] { intake_.drain(); });
  if (beat_.follows()) stop_.follow_sync(beat_.sync_lost());
  const bool beats = beat_.follows() ? beat_.began_by_sync() : send_sync();
  bus_.pdos.inputs().begin(beat_.cycle(), beat_.sync_at(), beats);
  bus_.status.beats += beats || beat_.has_sync();
  slack_.relieve_services();
}

/// Returns false if a SYNC is due and was not sent.
template <Port P, FrontLink L, Services S>
bool BusLoop<P, L, S>::send_sync() noexcept {
  if (!bus_.plan.cycle.sync || bus_.observe) return true;
  if (bus_.services.take_sync_restart()) beat_.restart_counter();
  if (stop_.withholds_sync() || !beat_.permits_sync(bus_.services)) return false;
  const Frame sync = beat_.sync();
  if (sender_.send({&sync, 1}) != 1) return false;
  beat_.on_sync_sent();
  return true;
}

template <Port P, FrontLink L, Services S>
void BusLoop<P, L, S>::publish() noexcept {
  bus_.status.port = port_.condition();
  published_ = port_.now();
  images_.publish(bus_.status.port, published_, intake_.predicted());
  sender_.on_condition(bus_.status.port, published_);
  images_.run_controller();
  bus_.pdos.inputs().forget_marks();
}

template <Port P, FrontLink L, Services S>
void BusLoop<P, L, S>::run_motions() noexcept {
  motions_.run({.cycle = beat_.cycle(), .now = published_}, stop_.stops().stopping());
}

/// Runs the services and the requests, then advances the stops.
template <Port P, FrontLink L, Services S>
void BusLoop<P, L, S>::use_slack() noexcept {
  slack_.extend_deadlines();
  stop_.end_halt();
  serve_round();
  while (slack_.has_many_rounds() && slack_.rest_until_next_round()) {
    report_.give_events();
    serve_round();
  }
  stop_.step(front_, port_.now());
}

template <Port P, FrontLink L, Services S>
void BusLoop<P, L, S>::serve_round() noexcept {
  requests_.take_request();
  stop_.submit_requests(port_);
  slack_.run_round();
  requests_.give_replies();
}

template <Port P, FrontLink L, Services S>
void BusLoop<P, L, S>::send_outputs() noexcept {
  stop_.stop_after_loss();
  if (beat_.next_sync_came()) return;  // These outputs belong to the next cycle.
  port_.sleep_until(beat_.outputs_due());
  if (!bus_.observe && !stop_.withholds_outputs()) outputs_.send();
}

}  // namespace takt

#include "master/rt/bus_loop_checkpoint.hpp"
