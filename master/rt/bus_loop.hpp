#pragma once
#include <algorithm>
#include <array>
#include <cstddef>
#include <cstdint>
#include <optional>
#include <span>
#include <vector>

#include "eds_parser/table/bus_plan.hpp"
#include "master/core/bus_trouble.hpp"
#include "master/core/fallback_writer.hpp"
#include "master/core/kept_state.hpp"
#include "master/core/network.hpp"
#include "master/core/ordered_stop.hpp"
#include "master/core/pdo_exchange.hpp"
#include "master/core/pdo_requests.hpp"
#include "master/core/stop_requests.hpp"
#include "master/core/time_producer.hpp"
#include "master/rt/arrival_prediction.hpp"
#include "master/rt/beat_clock.hpp"
#include "master/rt/controller.hpp"
#include "master/rt/exchange.hpp"
#include "master/rt/port.hpp"
#include "master/rt/port_watch.hpp"
#include "master/rt/recorded_port.hpp"
#include "master/rt/service_queue.hpp"
#include "master/rt/sync_follower.hpp"
#include "master/rt/sync_gate.hpp"
#include "master/rt/sync_hold.hpp"
#include "master/rt/wire_time.hpp"

namespace takt {

struct BusLoopOptions {
  bool observe = false;              ///< listen only: nothing at all is sent
  Controller* controller = nullptr;  ///< called in each cycle; outlives the loop
};

/// What is recorded can be gone on with in the middle of a run.
template <class P, class N>
inline constexpr bool keeps_state = WitnessPort<P> && requires(const N machine) { machine.idle(); };

/// The bus thread: one SYNC cycle after another. A complete cycle makes six system calls (sleep,
/// SYNC, sleep, receive, sleep, outputs), one with a missing PDO eight; service frames add theirs.
/// Nothing allocates, locks or throws after construction. `N` is the machine of the services:
/// boot, SDO, NMT.
template <Port P, class N = Network>
class BusLoop {
 public:
  /// Keeps references to all three.
  BusLoop(const BusPlan& plan, P& port, Exchange& exchange, BusLoopOptions options = {});
  BusLoop(const BusLoop&) = delete;
  BusLoop& operator=(const BusLoop&) = delete;

  /// The first SYNC comes one period from now.
  void start() noexcept;
  /// Instead of start(): goes on behind the publishing of the cycle in which another loop of this
  /// plan has written its checkpoint, to the end of that cycle. False: it is of another plan.
  bool resume(std::span<const std::uint64_t> checkpoint) noexcept;
  /// One whole cycle: returns after its outputs were sent.
  void cycle() noexcept;
  void request_stop() noexcept { exchange_.stop_requested.store(true, std::memory_order_relaxed); }
  /// The ordered stop is over; no cycle may follow.
  bool done() const noexcept { return done_; }

 private:
  static constexpr std::size_t batch = 256;              ///< frames taken by one receive
  static constexpr unsigned most_wakes = 8;              ///< of one cycle, for PDOs that are late
  static constexpr unsigned patience_with_services = 2;  ///< cycles without room for them
  static constexpr std::size_t burst_frames = 6;         ///< handed over at once; queues are short
  static constexpr std::size_t burst_ahead = 3;          ///< still in the queue when more follow
  static constexpr Time long_cycle = std::chrono::milliseconds{50};
  static constexpr Time round_distance = std::chrono::milliseconds{10};  ///< in a long cycle
  static constexpr unsigned patience_with_stalls = 16;  ///< one after another, before a SYNC
  static constexpr int longest_lapse = 2;  ///< periods without this thread that nobody need know of
  static constexpr Time status_interval = std::chrono::milliseconds{10};

  void finish_cycle() noexcept;
  bool idle() const noexcept;
  void keep_state() noexcept;
  template <class Archive>
  void keep(Archive& state) noexcept;
  void follow_nodes() noexcept;
  void expect_started_nodes() noexcept;
  void wait_for_beat() noexcept;
  void wait_for_sync() noexcept;
  void await_sync() noexcept;
  void react_to_sync() noexcept;
  void begin_beat() noexcept;
  void look_at_wire() noexcept;
  void note_held() noexcept;
  bool send_sync() noexcept;
  void relieve_services() noexcept;
  Time end_of_window() const noexcept;
  void receive() noexcept;
  void await_rest(Time end) noexcept;
  void drain() noexcept;
  bool begins_cycle(const StampedFrame& stamped) noexcept;
  void record_skipped(std::uint64_t missed) noexcept;
  void note_missed(std::uint64_t missed, Time now) noexcept;
  bool outputs_rest() const noexcept;
  void learn(bool in_time) noexcept;
  void publish() noexcept;
  void run_controller(const ImageStamp& stamp) noexcept;
  void predict_next_publish(Time now) noexcept;
  void excuse_absence() noexcept;
  void serve() noexcept;
  void serve_round() noexcept;
  bool rest_until_next_round() noexcept;
  enum class Handed : std::uint8_t {
    nothing,   ///< there was none, or no room for it
    requests,  ///< answers will come soon
    burst,     ///< nobody answers, more may follow as the wire takes them
  };
  Time under_way(std::size_t open) const noexcept;
  Handed send_services(std::size_t& budget, Time under_way) noexcept;
  std::size_t hand_over(std::size_t most) noexcept;
  bool behind_stream(Time now) const noexcept;
  void send_time() noexcept;
  void take_requests() noexcept;
  bool submit(const Request& request) noexcept;
  void give_replies() noexcept;
  void stop_drives_after_loss() noexcept;
  void send_outputs() noexcept;
  bool word_under_way(const StopAxis& axis) const noexcept;
  void remember_axes() noexcept;
  void remember_word(const Request& request) noexcept;
  void step_stop() noexcept;
  void begin_stop(Time now) noexcept;
  StopView stop_view() const noexcept;
  void force_axes(const OrderedStop& stop) noexcept;
  void tell_unconfirmed(const OrderedStop& stop, Time now) noexcept;
  void ask_for_stop() noexcept;
  void take_answer_of_stop() noexcept;
  OrderedStop& active_stop() noexcept;
  bool stops_in_order(std::size_t axis) noexcept;
  void follow_own_state() noexcept;
  std::optional<std::uint8_t> halt_target() const noexcept;
  void begin_halt(Time now, std::uint8_t node_index) noexcept;
  void step_halt(Time now) noexcept;
  void end_halt() noexcept;
  bool silent() const noexcept;
  void take_fallbacks() noexcept;
  void call_off_fallbacks() noexcept;
  bool stalled(Time now) const noexcept;
  void write_fallbacks() noexcept;
  SyncState sync_state() const noexcept;
  void give_events() noexcept;
  void write_status() noexcept;
  std::size_t send(std::span<const Frame> frames) noexcept;
  // What comes from the front thread and goes there; past the port where it wants to see it.
  const SetPointFrame& newest_set_points() noexcept;
  bool next_request() noexcept;
  bool asked_to_stop() noexcept;
  bool give_reply() noexcept;
  void give_event(Event& event) noexcept;
  void tell(EventKind kind, Time now, std::int64_t value = 0, std::uint32_t detail = 0) noexcept;

  const BusPlan& plan_;
  P& port_;
  Exchange& exchange_;
  BusLoopOptions options_;

  EventQueue events_;
  PdoExchange pdos_;
  N network_;
  PdoRequests pdo_requests_;
  TimeProducer time_;
  OrderedStop stop_;
  OrderedStop halt_;  ///< the same before NMT ends the PDO exchange; in NMT Stopped it lasts on
  std::vector<AxisMemory> memory_;  ///< of the axes of stop_
  StopRequests stop_requests_;
  FallbackWriter fallbacks_;
  PortWatch port_watch_;
  ServiceQueue services_;
  BeatClock clock_;
  SyncCounter counter_;
  SyncHold hold_;
  SyncGate gate_;
  SyncFollower follower_;
  ArrivalPrediction prediction_;
  WireTime wire_;
  std::vector<StampedFrame> received_;
  std::size_t left_from_ = 0;  ///< frames of `received_` behind a SYNC: of the next cycle
  std::size_t left_end_ = 0;
  std::array<bool, 128> exchanging_{};
  std::vector<std::uint8_t> quick_stopped_;  ///< per axis of stop_: after the loss of a node
  bool hearing_ = false;                     ///< PDOs of some node are taken
  BusStatus status_;
  Reply reply_;
  Request request_;
  bool reply_waits_ = false;
  bool done_ = false;
  bool gate_open_ = true;   ///< frames may be sent in this cycle
  bool followed_ = false;   ///< the followed SYNC began this cycle
  bool sync_lost_ = false;  ///< and is lost; its reaction is in force
  Time wire_free_{};        ///< the service frames handed over in this cycle have ended
  std::size_t asked_ = 0;   ///< SDO requests handed over since the last round
  Time stream_end_{};       ///< of the newest that was asked for, at the latest
  unsigned starved_ = 0;    ///< cycles in which service frames found no room
  std::uint64_t held_ = 0;  ///< cycles since it was open
  MissedBecause held_because_ = MissedBecause::not_seen;
  bool late_cycle_ = false;  ///< this thread was late in the newest cycle, before its publication
  Time sync_sent_{};         ///< of this cycle
  Time last_sync_{};         ///< of the cycle before
  Time sync_time_{};         ///< the same, by its echo where there is one
  Time last_status_{};
  Time published_{};             ///< kept where checkpoints are
  std::size_t state_words_ = 0;  ///< of a checkpoint
};

}  // namespace takt

#include "master/rt/bus_loop_checkpoint.hpp"
#include "master/rt/bus_loop_front.hpp"
#include "master/rt/bus_loop_impl.hpp"
#include "master/rt/bus_loop_services.hpp"
#include "master/rt/bus_loop_stop.hpp"
#include "master/rt/bus_loop_sync.hpp"
