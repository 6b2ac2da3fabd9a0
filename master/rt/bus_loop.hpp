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
#include "master/core/kept_state.hpp"
#include "master/core/network/network.hpp"
#include "master/core/network/ordered_stop.hpp"
#include "master/core/network/stop_requests.hpp"
#include "master/core/network/time_producer.hpp"
#include "master/core/pdo/fallback_writer.hpp"
#include "master/core/pdo/pdo_exchange.hpp"
#include "master/core/pdo/pdo_requests.hpp"
#include "master/rt/arrival_prediction.hpp"
#include "master/rt/beat_clock.hpp"
#include "master/rt/controller.hpp"
#include "master/rt/exchange/exchange.hpp"
#include "master/rt/exchange/front_link.hpp"
#include "master/rt/port.hpp"
#include "master/rt/port_watch.hpp"
#include "master/rt/service_queue.hpp"
#include "master/rt/services.hpp"
#include "master/rt/sync_follower.hpp"
#include "master/rt/sync_gate.hpp"
#include "master/rt/sync_hold.hpp"
#include "master/wire/wire_time.hpp"

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
  /// Runs the rest of that cycle, from behind the publication of its image. Returns false if the
  /// checkpoint belongs to another plan.
  bool resume(std::span<const std::uint64_t> checkpoint) noexcept;
  /// Runs one whole cycle and returns after its outputs have been sent.
  void cycle() noexcept;
  void request_stop() noexcept { exchange_.stop_requested.store(true, std::memory_order_relaxed); }
  /// Returns true once the ordered stop is complete; the caller must not run another cycle.
  bool done() const noexcept { return done_; }

 private:
  static constexpr std::size_t batch = 256;  ///< most frames that one receive takes
  /// Most wake-ups of one cycle for late PDOs.
  static constexpr unsigned most_wakes = 8;
  /// Cycles without room for service frames before one is forced out.
  static constexpr unsigned patience_with_services = 2;
  /// Most frames handed over at once, because interface queues are short.
  static constexpr std::size_t burst_frames = 6;
  /// Frames still in the queue when the next ones follow.
  static constexpr std::size_t burst_ahead = 3;
  static constexpr Time long_cycle = std::chrono::milliseconds{50};
  /// Time between the service rounds of a long cycle.
  static constexpr Time round_distance = std::chrono::milliseconds{10};
  /// Successive stalls tolerated before a SYNC.
  static constexpr unsigned patience_with_stalls = 16;
  /// Longest absence of this thread, in periods, that time-outs need not take into account.
  static constexpr int longest_lapse = 2;
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
    nothing,   ///< there were no frames, or no room for them
    requests,  ///< answers to these frames will come soon
    burst,     ///< these frames have no answers; more may follow as the wire takes them
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
  bool halt_is_over() const noexcept;
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
  void give_event(Event& event) noexcept;
  void tell(EventKind kind, Time now, std::int64_t value = 0, std::uint32_t detail = 0) noexcept;

  const BusPlan& plan_;
  P& port_;
  L front_;
  Exchange& exchange_;
  BusLoopOptions options_;

  EventQueue events_;
  PdoExchange pdos_;
  S network_;
  PdoRequests pdo_requests_;
  TimeProducer time_;
  OrderedStop stop_;
  /// Stops axes before NMT ends their PDO exchange; lasts as long as NMT Stopped.
  OrderedStop halt_;
  std::vector<AxisMemory> memory_;  ///< one element per axis of stop_
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
  /// First and end of the frames in `received_` behind a SYNC; they belong to the next cycle.
  std::size_t left_from_ = 0;
  std::size_t left_end_ = 0;
  std::array<bool, 128> exchanging_{};
  /// Per axis of stop_: 1 while the loss of another node forces its controlword.
  std::vector<std::uint8_t> quick_stopped_;
  bool hearing_ = false;  ///< the loop takes PDOs of at least one node
  BusStatus status_;
  Reply reply_;
  Request request_;
  bool reply_waits_ = false;
  bool done_ = false;
  bool gate_open_ = true;   ///< the loop may send frames in this cycle
  bool followed_ = false;   ///< the followed SYNC began this cycle
  bool sync_lost_ = false;  ///< the followed SYNC is lost and the configured reaction is in force
  /// Time at which the service frames handed over in this cycle have left the wire.
  Time wire_free_{};
  std::size_t asked_ = 0;   ///< SDO requests handed over since the last round
  Time stream_end_{};       ///< latest end of the newest sub-block that was requested
  unsigned starved_ = 0;    ///< cycles in which service frames found no room
  std::uint64_t held_ = 0;  ///< cycles held back since the gate was last open
  MissedBecause held_because_ = MissedBecause::not_seen;
  /// This thread was late in the newest cycle, before the image was published.
  bool late_cycle_ = false;
  Time sync_sent_{};  ///< SYNC of this cycle
  Time last_sync_{};  ///< SYNC of the previous cycle
  Time sync_time_{};  ///< SYNC of this cycle, by its echo if there is one
  Time last_status_{};
  Time published_{};             ///< publish time of the newest image
  std::size_t state_words_ = 0;  ///< size of a checkpoint
};

}  // namespace takt

#include "master/rt/bus_loop_checkpoint.hpp"
#include "master/rt/bus_loop_impl.hpp"
#include "master/rt/bus_loop_services.hpp"
#include "master/rt/bus_loop_stop.hpp"
#include "master/rt/bus_loop_sync.hpp"
