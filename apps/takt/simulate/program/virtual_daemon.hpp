#pragma once
#include <cstdint>
#include <functional>
#include <memory>

#include "apps/takt/simulate/program/rewriting_transport.hpp"
#include "apps/takt/simulate/program/stage.hpp"
#include "apps/takt/simulate/program/staged_port.hpp"
#include "apps/takt/simulate/program/virtual_lcm.hpp"
#include "master/gateway/bridge.hpp"
#include "master/gateway/front_round.hpp"
#include "master/lcm/clocks.hpp"
#include "master/master_run.hpp"
#include "master/sim/random.hpp"

namespace takt {

/// Clocks of the simulated machine that the programs run on.
class VirtualClocks final : public Clocks {
 public:
  explicit VirtualClocks(const sim::World& world) : world_{world} {}
  Time now() const noexcept override { return world_.now(); }
  Time wall_offset() const noexcept override { return wall_; }
  /// Sets the wall clock: its offset to the monotonic clock.
  void set_wall(Time offset) noexcept { wall_ = offset; }

 private:
  const sim::World& world_;
  Time wall_ = std::chrono::days{20454};
};

/// Runs taktd in virtual time: cycle() is the bus thread, and the actor is the front thread. Both
/// use the code of the real daemon: the MasterRun and the Bridge, in the order of FrontRound.
class VirtualDaemon final : public Actor, private FrontGuest {
 public:
  struct Hears {
    /// Called with each image when the front thread receives it.
    std::function<void(const ImageView& image, Time now)> image;
    std::function<void(const Notice& notice)> notice;
    std::function<void(const Event& event)> event;
  };
  /// For tests: changes the round of each new process.
  using RoundHook = std::function<void(FrontRound& round)>;

  VirtualDaemon(const BusPlan& plan, StagedPort& port, VirtualLcm& lcm, const Clocks& clocks,
                sim::Random random);
  void hear(Hears hears) { hears_ = std::move(hears); }
  void on_round(RoundHook on_round) { round_hook_ = std::move(on_round); }
  /// For tests: changes each command before the front thread receives it.
  void rewrite(RewritingTransport::Rewrite rewrite) { transport_.rewrite(std::move(rewrite)); }
  /// For tests: changes each message about motions before the front thread receives it.
  void rewrite(RewritingTransport::RewriteMotion rewrite) {
    transport_.rewrite(std::move(rewrite));
  }
  void rewrite(RewritingTransport::RewriteGear rewrite) { transport_.rewrite(std::move(rewrite)); }
  void rewrite(RewritingTransport::RewriteStream rewrite) {
    transport_.rewrite(std::move(rewrite));
  }

  /// Starts a new process with a new session.
  void start();
  /// Ends the process at once and discards all messages in its queue. Must not be called within a
  /// cycle.
  void kill();
  /// Runs the next cycle of the bus thread.
  void cycle() { master_->cycle(); }
  /// Keeps the front thread from running before `until`.
  void stall(Time until) noexcept { stalled_until_ = std::max(stalled_until_, until); }

  /// Lets the front thread process all reports that the bus thread made before the bus thread
  /// ended.
  void hear_the_end() {
    do {
      bridge_->serve();
    } while (bridge_->has_unsent_reports());
  }

  bool runs() const noexcept { return bridge_ != nullptr; }
  bool finished() const noexcept { return master_->finished(); }
  void request_stop() { master_->request_stop(); }
  std::int64_t session() const noexcept { return session_; }
  const MasterRun& master() const noexcept { return *master_; }
  const Bridge& bridge() const noexcept { return *bridge_; }
  /// Returns the number of messages lost because the queue was full, over all processes of this
  /// daemon.
  std::uint64_t lost() const noexcept { return lcm_.dropped(); }
  Time stalled_until() const noexcept { return stalled_until_; }

  Time next() const noexcept override;
  void act(Time now) override;

 private:
  void wait(Time next_image, Time latest) noexcept;
  void take(const Reply&) override {}
  void hear(const Event& event) override;
  void see(const ImageView& image) override;

  const BusPlan& plan_;
  StagedPort& port_;
  const Clocks& clocks_;  // clocks of the front thread
  sim::Random random_;
  VirtualEndpoint& lcm_;
  // Transport of the front thread, which passes on the messages of `lcm_`.
  RewritingTransport transport_;
  Hears hears_;
  RoundHook round_hook_;
  std::int64_t session_ = 0;
  std::unique_ptr<MasterRun> master_;
  std::unique_ptr<Bridge> bridge_;
  FrontRound round_;
  Time wake_ = never;   // end of the wait, or begin of the next step of the round
  bool waits_ = false;  // a message ends the wait
  Time stalled_until_{};
};

}  // namespace takt
