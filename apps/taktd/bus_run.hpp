#pragma once
#include <bitset>
#include <cstdint>
#include <memory>
#include <optional>
#include <poll.h>
#include <string>
#include <vector>

#include "apps/master/opened_bus.hpp"
#include "apps/taktd/ascii_front.hpp"
#include "apps/taktd/daemon_options.hpp"
#include "apps/taktd/exit.hpp"
#include "apps/taktd/other_master.hpp"
#include "apps/taktd/process/front_wait.hpp"
#include "apps/taktd/process/service_notify.hpp"
#include "apps/taktd/recorder.hpp"
#include "apps/taktd/reporter.hpp"
#include "eds_parser/network_file/load_network.hpp"
#include "master/gateway/bridge.hpp"
#include "master/lcm/clocks.hpp"
#include "master/lcm/envelope/secured_transport.hpp"
#include "master/lcm/link/lcm_link.hpp"
#include "master/linux/bus/bus_claim.hpp"
#include "master/linux/rt_thread.hpp"
#include "master/master_run.hpp"

namespace takt {

/// The objects that all buses of one taktd share. They must outlive the buses.
struct FrontThread {
  const DaemonOptions& options;
  const Clocks& clocks;
  const FrontWait& wait;
  ServiceNotify& service;
  Reporter& reporter;
};

/// Runs one bus, from the compiled network to the end of the ordered stop. The member functions
/// execute on the front thread; the MasterRun owns the bus thread.
class BusRun {
 public:
  BusRun(LoadedNetwork network, const FrontThread& front);

  /// Locks the bus against a second taktd. Returns the exit code if another taktd has the lock.
  std::optional<Exit> claim();
  /// Opens the bus, LCM and the files, and looks for another master. Returns the exit code if the
  /// bus can't start.
  std::optional<Exit> open();
  /// Starts the bus thread. Returns the exit code if it can't run.
  std::optional<Exit> start();

  /// Returns the bus, its interface and its name, for the status line of systemd.
  std::string title() const { return "bus " + network_.plan.name + " on " + bus_name_; }
  bool wants_realtime() const noexcept { return network_.realtime.mode != RtMode::off; }
  /// Returns the flag that begins the ordered stop. A signal handler may set it.
  std::atomic<bool>& stop_requested() noexcept { return master_->stop_requested(); }
  Time next_image() const noexcept { return master_->next_publish(); }
  /// Does everything that can be done now. Returns the latest time of the next call.
  Time serve();
  void watch(std::vector<pollfd>& descriptors) const;
  /// Begins a recording of the black box, if the bus has one.
  void record(const std::string& why) { recorder_.record(why, front_.clocks.now()); }
  /// Returns the time of the newest status that the bus thread has written.
  Time alive() const noexcept { return bridge_->status().bus.when; }

  /// Begins the ordered stop, unless it has begun already. `reason` becomes the exit code unless
  /// the stop is not confirmed.
  void stop(Exit reason, const std::string& why);
  /// Ends the run because the time of --for is over. The result is good unless a mandatory node
  /// that the master boots has never been ready.
  void end_of_time();
  bool stopping() const noexcept { return stopping_; }
  /// Returns true when the ordered stop is over.
  bool finished() const noexcept { return master_->finished(); }
  /// Returns true if the end of the ordered stop is overdue at `now`.
  bool overdue(Time now) const noexcept { return stopping_ && now > stop_limit_; }

  /// Completes a run whose ordered stop is over: checks the result of the stop, completes the
  /// recording and writes the summary. Returns false if a recording is still being written.
  bool complete();
  /// Completes a run whose ordered stop is not over, and saves what has been recorded. `by_signal`:
  /// a second stop signal has ended the stop, not its time limit.
  void cut_short(bool by_signal);
  Exit result() const noexcept { return exit_; }

 private:
  std::optional<Exit> open_lcm(LcmUrl url);
  std::optional<Exit> open_keys(std::vector<std::string> guarded);
  std::optional<Exit> open_gateway();
  std::optional<Exit> open_black_box();
  std::optional<Exit> look_for_master();
  void listen(OtherMaster& other);
  void hear_intruders();
  void watch_lateness();
  void on_notice(const Notice& notice);
  void on_refused_envelope(const std::string& sentence);
  std::string never_ready() const;
  void judge_stop();
  Exit exit_of_cut_stop() const;
  void say(Weight weight, const std::string& sentence) { front_.reporter.say(weight, sentence); }
  /// Reports the reason why the bus can't start, and returns the exit code.
  Exit refuse(Exit code, const std::string& why) {
    say(Weight::error, why);
    return code;
  }

  LoadedNetwork network_;
  FrontThread front_;
  std::string bus_name_;
  std::int64_t session_;
  std::bitset<256> once_ready_;  // nodes that have booted in this run
  RtReport realtime_;
  Recorder recorder_;               // outlives master_
  std::optional<BusClaim> claim_;   // empty with --observe
  std::unique_ptr<OpenedBus> bus_;  // outlives master_, whose thread uses it
  std::unique_ptr<MasterRun> master_;
  std::unique_ptr<LcmLink> link_;
  std::unique_ptr<SecuredTransport> secured_;  // null without keys
  std::unique_ptr<Bridge> bridge_;
  std::unique_ptr<AsciiFront> gateway_;
  Time stop_limit_ = never;  // time at which the daemon stops waiting for the ordered stop
  bool stopping_ = false;
  Exit exit_ = Exit::good;
  std::string why_;          // reason for exit_
  std::string unconfirmed_;  // list of the axes that the ordered stop did not confirm
};

}  // namespace takt
