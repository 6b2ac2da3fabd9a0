#pragma once
#include <atomic>
#include <cstdint>
#include <functional>
#include <memory>
#include <span>
#include <thread>
#include <type_traits>
#include <utility>

#include "eds_parser/table/bus_plan.hpp"
#include "master/rt/bus_loop.hpp"
#include "master/rt/exchange.hpp"

namespace takt {

struct MasterOptions {
  bool observe = false;              ///< listen only: nothing at all is sent
  Controller* controller = nullptr;  ///< runs inside the bus thread; outlives the master
};

/// Starts a thread that runs `body`; where real time comes from (takt_linux knows how).
using StartThread = std::function<std::thread(std::function<void()> body)>;

/// A plain thread of no priority.
std::thread start_plain_thread(std::function<void()> body);

/// A CANopen master for one bus: runs a plan on a port. The bus thread is its own; everything
/// public here belongs to one other thread, the front thread.
class Master {
 public:
  explicit Master(BusPlan plan, MasterOptions options = {});
  ~Master();  ///< asks for the ordered stop and waits for it
  Master(const Master&) = delete;
  Master& operator=(const Master&) = delete;

  /// The bus. `port` outlives the master.
  template <Port P>
  void attach(P& port) {
    runner_ = std::make_unique<Runner<P>>(plan_, port, *exchange_, options_);
  }

  /// Runs the cycles on a thread of their own until the ordered stop is over.
  void start(const StartThread& start_thread = start_plain_thread);
  /// Instead of start(): the calling thread begins, then makes one cycle at a time (virtual time).
  void begin() noexcept { runner_->start(); }
  bool cycle() noexcept;

  /// Begins the ordered stop; finished() tells its end, within BusPlan::stop_timeout.
  void request_stop() noexcept { exchange_->stop_requested.store(true); }
  /// What request_stop() sets: for a signal handler. Lives as long as the master.
  std::atomic<bool>& stop_requested() noexcept { return exchange_->stop_requested; }
  bool finished() const noexcept { return exchange_->finished.load(std::memory_order_acquire); }
  /// Waits for the bus thread to end.
  void join();

  const BusPlan& plan() const noexcept { return plan_; }

  /// The next image in order, or only the newest; valid until the next call.
  bool take(ImageView& image) noexcept { return exchange_->images.take(image); }
  bool take_newest(ImageView& image) noexcept { return exchange_->images.take_newest(image); }
  bool take(Event& event) noexcept { return exchange_->events.pop(event); }
  bool take(Reply& reply) noexcept { return exchange_->replies.pop(reply); }
  /// When the next image will be there: sleep to it instead of being woken. Read it before looking
  /// for images: each image that was there before the prediction was made is seen by a take() that
  /// comes after this call.
  Time next_publish() const noexcept {
    return Time{exchange_->next_publish.load(std::memory_order_acquire)};
  }

  /// Stages the command of one output; `signal` counts in the whole layout. False: no output.
  bool set(SignalIndex signal, std::int64_t value, std::uint32_t time_to_live = 0) noexcept;
  struct Command {
    SignalIndex signal = 0;
    std::int64_t value = 0;
  };
  /// Stages `commands` and hands them over as one set, with what was staged before: those for
  /// synchronous RPDOs (types 0..240) become valid with one and the same SYNC. Where their frames
  /// find no room in a cycle, all wait for the next. False: one is no output, nothing is handed
  /// over.
  bool set_group(std::span<const Command> commands, Time now,
                 std::uint32_t time_to_live = 0) noexcept;
  /// Hands all staged commands to the bus thread, as one set.
  void publish_outputs(Time now) noexcept { exchange_->set_points.publish(now); }

  /// False: too many at once, ask again later. Each accepted request is answered exactly once.
  bool submit(const Request& request) noexcept { return exchange_->requests.push(request); }

  /// Buffers for values that are too long for a request; they live as long as the master.
  std::span<SdoTransfer> transfers() noexcept { return exchange_->transfers; }

  void status(StatusSnapshot& snapshot) const { exchange_->status.read(snapshot); }
  const TimingHistograms& timing() const noexcept { return exchange_->timing; }
  std::uint64_t image_overruns() const noexcept { return exchange_->images.overruns(); }
  std::uint64_t event_overruns() const noexcept { return exchange_->events.overruns(); }

 private:
  struct AnyRunner {
    virtual ~AnyRunner() = default;
    virtual void start() noexcept = 0;
    virtual void cycle() noexcept = 0;
    virtual bool done() const noexcept = 0;
  };
  template <Port P>
  struct Runner final : AnyRunner {
    Runner(const BusPlan& plan, P& port, Exchange& exchange, const MasterOptions& options)
        : loop{plan,
               port,
               exchange,
               {.observe = options.observe, .controller = options.controller}} {}
    void start() noexcept override { loop.start(); }
    void cycle() noexcept override { loop.cycle(); }
    bool done() const noexcept override { return loop.done(); }
    BusLoop<P> loop;
  };

  void run() noexcept;

  BusPlan plan_;
  MasterOptions options_;
  std::unique_ptr<Exchange> exchange_;
  std::unique_ptr<AnyRunner> runner_;
  std::thread thread_;
};

}  // namespace takt
