#pragma once
#include <atomic>
#include <cstdint>
#include <expected>
#include <functional>
#include <memory>
#include <span>
#include <thread>

#include "eds_parser/table/bus_plan.hpp"
#include "master/rt/controller.hpp"
#include "master/rt/exchange/exchange.hpp"
#include "master/rt/journal/journal.hpp"
#include "master/rt/port.hpp"

namespace takt {

/// Options of a MasterRun.
struct MasterRunOptions {
  bool observe = false;              ///< The master only listens and sends nothing.
  Controller* controller = nullptr;  ///< Runs inside the bus thread; nullptr means no controller.
                                     ///< It must outlive the master.
};

/// Starts a thread that runs `body`, or returns the errno if the machine refuses another thread.
/// The library takt_linux has one that gives the thread real-time priority.
using StartThread = std::function<std::expected<std::thread, int>(std::function<void()> body)>;

/// Starts a thread with the default scheduling policy.
std::thread start_plain_thread(std::function<void()> body);

/// One run of the master on one bus: it runs a plan on a port. The bus thread belongs to the run;
/// all public functions must be called from one other thread, the front thread.
class MasterRun {
 public:
  explicit MasterRun(BusPlan plan, MasterRunOptions options = {});
  ~MasterRun();  ///< Requests the ordered stop and waits for its end.
  MasterRun(const MasterRun&) = delete;
  MasterRun& operator=(const MasterRun&) = delete;

  /// Connects the master to its bus; call this once, before start() or begin(). The run is recorded
  /// to `journal`, unless that is null. `port` and `journal` must outlive the master. The
  /// definition is in master/attach.hpp, which compiles the bus loop for the port.
  template <Port P>
  void attach(P& port, Journal* journal = nullptr);

  /// Runs the cycles on the bus thread until the ordered stop is over. Returns the errno if the bus
  /// thread could not be started.
  std::expected<void, int> start(const StartThread& start_thread = start_plain_thread);
  /// Replaces start() when the calling thread runs the cycles itself, for example in virtual time.
  void begin() noexcept { runner_->start(); }
  /// Runs one cycle after begin(). Returns false when the ordered stop is over.
  bool cycle() noexcept;

  /// Begins the ordered stop. finished() returns true when it is over, within
  /// BusPlan::stop_timeout.
  void request_stop() noexcept { exchange_->stop_requested.store(true); }
  /// Returns the flag that request_stop() sets, for use in a signal handler. It lives as long as
  /// the master.
  std::atomic<bool>& stop_requested() noexcept { return exchange_->stop_requested; }
  /// Returns true when the ordered stop is over.
  bool finished() const noexcept { return exchange_->finished.load(std::memory_order_acquire); }
  /// Waits for the bus thread to end.
  void join();

  /// Returns the plan of the bus, as it was given to the constructor.
  const BusPlan& plan() const noexcept { return plan_; }

  /// Takes the next process image in order. Returns false if there is none. The image is valid
  /// until the next call of take() or take_newest().
  bool take(ImageView& image) noexcept { return exchange_->images.take(image); }
  /// Takes the newest process image and drops the older ones. Returns false if there is none.
  bool take_newest(ImageView& image) noexcept { return exchange_->images.take_newest(image); }
  /// Takes the next event in order. Returns false if there is none.
  bool take(Event& event) noexcept { return exchange_->events.pop(event); }
  /// Takes the next reply to a request. Returns false if there is none.
  bool take(Reply& reply) noexcept { return exchange_->replies.pop(reply); }
  /// Returns the predicted time of the next image, on the monotonic clock. The front thread sleeps
  /// until then, because the bus thread does not wake it. Read this time before you look for
  /// images: a take() after this call sees every image that was there before the prediction was
  /// made.
  Time next_publish() const noexcept {
    return Time{exchange_->next_publish.load(std::memory_order_acquire)};
  }

  /// Stages the command of one output; publish_outputs() hands it over. `signal` is the index in
  /// the whole layout. `value` is raw. `time_to_live` is in cycles; 0 means the configured one.
  /// Returns false if `signal` is no output.
  bool set(SignalIndex signal, std::int64_t value, std::uint32_t time_to_live = 0) noexcept;
  /// Hands all staged commands to the bus thread as one set. Commands for synchronous RPDOs
  /// (transmission types 0..240) become valid with the same SYNC. If their frames do not fit into
  /// one cycle, all of them wait for the next. `now` is on the monotonic clock.
  void publish_outputs(Time now) noexcept { exchange_->set_points.publish(now); }

  /// Hands a request to the bus thread. Returns false if too many requests wait; submit it again
  /// later. Each accepted request is answered exactly once.
  bool submit(const Request& request) noexcept { return exchange_->requests.push(request); }

  /// Hands a message about motions to the bus thread. Returns false if too many messages wait;
  /// submit it again later. Points of streams are refused earlier, so that room is left for the
  /// other kinds of messages.
  bool submit(const motion::MotionMessage& message) noexcept {
    const bool waits = message.kind == motion::MessageKind::points &&
                       !exchange_->motions.has_room(motions_a_cycle + 1);
    return !waits && exchange_->motions.push(message);
  }
  /// Takes the next end of an order of motion. Returns false if there is none.
  bool take(motion::MotionEnd& end) noexcept { return exchange_->motion_ends.pop(end); }
  /// Copies the newest reports of all axes that can be moved.
  void motions(MotionSnapshot& snapshot) const { exchange_->motion_board.read(snapshot); }

  /// Buffers for SDO values that are too long for a request. They live as long as the master.
  std::span<SdoTransfer> transfers() noexcept { return exchange_->transfers; }

  /// Copies the status of the master and of all nodes.
  void status(StatusSnapshot& snapshot) const { exchange_->status.read(snapshot); }
  /// Returns a number that changes whenever the bus thread renews its status; 0 before the first.
  std::uint64_t status_version() const noexcept { return exchange_->status.version(); }
  /// Returns the histograms of the times in the cycle.
  const TimingHistograms& timing() const noexcept { return exchange_->timing; }
  /// Returns the number of images that were lost because the front thread did not take them in
  /// time.
  std::uint64_t image_overruns() const noexcept { return exchange_->images.overruns(); }
  /// Returns the number of events that were lost because the front thread did not take them in
  /// time.
  std::uint64_t event_overruns() const noexcept { return exchange_->events.overruns(); }

  /// The bus loop of any kind of port.
  struct Runner {
    virtual ~Runner() = default;
    virtual void start() noexcept = 0;
    virtual void cycle() noexcept = 0;
    virtual bool done() const noexcept = 0;
  };

 private:
  void run() noexcept;

  BusPlan plan_;
  MasterRunOptions options_;
  std::unique_ptr<Exchange> exchange_;
  std::unique_ptr<Runner> runner_;
  std::thread thread_;
};

}  // namespace takt
