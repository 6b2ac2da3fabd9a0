#pragma once
#include <memory>
#include <optional>
#include <vector>

#include "apps/taktd/bus_run.hpp"
#include "apps/taktd/daemon_options.hpp"
#include "apps/taktd/exit.hpp"
#include "apps/taktd/process/front_wait.hpp"
#include "apps/taktd/process/service_notify.hpp"
#include "apps/taktd/process/stop_signal.hpp"
#include "apps/taktd/reporter.hpp"
#include "eds_parser/network_file/load_network.hpp"
#include "master/lcm/clocks.hpp"

namespace takt {

/// The process taktd: its front thread, its signals and its buses. At present, the command line
/// names one network file, so the list of buses has one element.
class Daemon {
 public:
  Daemon(std::vector<LoadedNetwork> networks, DaemonOptions options);
  ~Daemon();

  /// Returns when the ordered stop of all buses is over. Call this once.
  Exit run();

 private:
  std::optional<Exit> open();
  std::optional<Exit> open_events();
  std::optional<Exit> start();
  void loop();
  Time next_image() const noexcept;
  Time serve();
  void wait(Time next_image, Time latest);
  bool finished() const noexcept;
  bool gives_up(Time now) const;
  void watch_conditions(Time now);
  void stop(Exit reason, const std::string& why);
  Exit result() const noexcept;
  [[noreturn]] void leave();

  DaemonOptions options_;
  StopSignal signals_;
  LinuxClocks clocks_;
  FrontWait wait_;
  std::vector<pollfd> descriptors_;
  ServiceNotify service_;
  Reporter reporter_;
  std::vector<std::unique_ptr<BusRun>> buses_;
  Time end_ = never;  // end of the time of --for
};

}  // namespace takt
