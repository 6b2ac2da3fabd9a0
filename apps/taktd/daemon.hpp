#pragma once
#include <bitset>
#include <cstdint>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "apps/taktd/ascii_front.hpp"
#include "apps/taktd/daemon_bus.hpp"
#include "apps/taktd/daemon_options.hpp"
#include "apps/taktd/other_master.hpp"
#include "apps/taktd/process/front_wait.hpp"
#include "apps/taktd/process/service_notify.hpp"
#include "apps/taktd/process/stop_signal.hpp"
#include "apps/taktd/recorder.hpp"
#include "apps/taktd/reporter.hpp"
#include "eds_parser/network_file/load_network.hpp"
#include "master/gateway/bridge.hpp"
#include "master/gateway/front_round.hpp"
#include "master/lcm/clocks.hpp"
#include "master/lcm/envelope/secured_transport.hpp"
#include "master/lcm/link/lcm_link.hpp"
#include "master/linux/bus/bus_claim.hpp"
#include "master/linux/rt_thread.hpp"
#include "master/master.hpp"

namespace takt {

/// Exit codes of taktd, documented in its help text.
enum class Exit : int {
  good = 0,
  refused = 1,
  wrong_use = 2,
  bus_trouble = 3,
  node_missing = 4,
  too_late = 5,
  not_stopped = 6,  ///< the ordered stop was not confirmed; this code overrides all others
};

/// Runs one bus, from the compiled network to the end of the ordered stop. run() executes on the
/// front thread; the Master owns the bus thread.
class Daemon {
 public:
  Daemon(LoadedNetwork network, DaemonOptions options);
  ~Daemon();

  Exit run();

 private:
  std::optional<Exit> open();
  std::optional<Exit> open_lcm(LcmUrl url);
  std::optional<Exit> open_keys(std::vector<std::string> guarded);
  void on_refused_envelope(const std::string& sentence);
  std::optional<Exit> open_black_box();
  std::optional<Exit> claim_bus();
  std::optional<Exit> look_for_master();
  void listen(OtherMaster& other);
  std::optional<Exit> start();
  void loop();
  Time serve();
  void wait(Time next_image, Time latest);
  bool gives_up(Time now) const;
  void hear_intruders();
  void watch_conditions(Time now);
  void watch_lateness();
  void on_notice(const Notice& notice);
  void end_of_time();
  std::string never_ready() const;
  void stop(Exit reason, const std::string& why);
  void judge_stop();
  Exit exit_of_cut_stop() const;
  std::thread start_bus_thread(std::function<void()> body);

  LoadedNetwork network_;
  DaemonOptions options_;
  std::string bus_name_;
  std::int64_t session_;
  StopSignal signals_;
  LinuxClocks clocks_;
  FrontWait wait_;
  std::vector<pollfd> descriptors_;
  ServiceNotify service_;
  Reporter reporter_;
  std::bitset<256> once_ready_;  // nodes that have booted in this run
  RtReport realtime_;
  bool bus_thread_runs_ = false;
  Recorder recorder_;               // outlives master_
  std::optional<BusClaim> claim_;   // empty with --observe
  std::unique_ptr<DaemonBus> bus_;  // outlives master_, whose thread uses it
  std::unique_ptr<Master> master_;
  std::unique_ptr<LcmLink> link_;
  std::unique_ptr<SecuredTransport> secured_;  // null without keys
  std::unique_ptr<Bridge> bridge_;
  std::unique_ptr<AsciiFront> gateway_;
  Time end_ = never;         // when the time of --for is over
  Time stop_limit_ = never;  // when the daemon stops waiting for the ordered stop
  bool stopping_ = false;
  Exit exit_ = Exit::good;
  std::string why_;          // reason for exit_
  std::string unconfirmed_;  // list of the axes that the ordered stop did not confirm
};

}  // namespace takt
