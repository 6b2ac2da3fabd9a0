#pragma once
#include <expected>
#include <memory>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "apps/master/simulated_bus.hpp"
#include "eds_parser/table/device_table.hpp"
#include "master/linux/bus/diagnostic_socket.hpp"
#include "master/linux/bus/open_bus.hpp"
#include "master/master_run.hpp"
#include "master/rt/journal/journal.hpp"

namespace takt {

/// The bus that a master runs on: an interface, a unix bus, or simulated devices in this
/// process.
class OpenedBus {
 public:
  static std::expected<std::unique_ptr<OpenedBus>, BusError> open(
      const std::string& name, const BusPlan& plan, std::span<const DeviceTable> devices,
      Time spin);

  /// Connects `master` to the bus. The bus thread records what it receives into `journal` for the
  /// black box; `journal` may be null.
  void attach(MasterRun& master, Journal* journal);
  /// Detects foreign masters and COB-IDs with two senders. Returns null on a simulated bus and if
  /// the socket could not be opened.
  DiagnosticSocket* diagnostics() noexcept { return diagnostics_ ? &*diagnostics_ : nullptr; }
  /// Each warning names a problem that will disturb the run and, where possible, the remedy.
  const std::vector<std::string>& warnings() const noexcept { return warnings_; }

 private:
  OpenedBus() = default;
  static std::expected<std::unique_ptr<OpenedBus>, BusError> open_real(const std::string& name,
                                                                       const BusPlan& plan,
                                                                       Time spin);

  SentFrames sent_;
  std::optional<AnyPort> port_;
  std::optional<DiagnosticSocket> diagnostics_;
  std::vector<std::string> warnings_;
  std::unique_ptr<SimulatedBus> simulated_;
};

}  // namespace takt
