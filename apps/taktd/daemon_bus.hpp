#pragma once
#include <expected>
#include <memory>
#include <optional>
#include <span>
#include <string>
#include <variant>
#include <vector>

#include "apps/taktd/simulated_bus.hpp"
#include "eds_parser/table/device_table.hpp"
#include "master/linux/diagnostic_socket.hpp"
#include "master/linux/open_bus.hpp"
#include "master/master.hpp"
#include "master/rt/recorded_port.hpp"

namespace takt {

/// The bus that the daemon runs on: an interface, a unix bus, or simulated devices in this
/// process.
class DaemonBus {
 public:
  static std::expected<std::unique_ptr<DaemonBus>, BusError> open(
      const std::string& name, const BusPlan& plan, std::span<const DeviceTable> devices,
      Time spin);

  /// `journal`: where the bus thread writes down what it hears, for the black box; may be null.
  void attach(Master& master, Journal* journal);
  /// Hears foreign masters and double senders; null on a simulated bus or where it can't be had.
  DiagnosticSocket* diagnostics() noexcept { return diagnostics_ ? &*diagnostics_ : nullptr; }
  /// What will hurt while running, with the command that mends it.
  const std::vector<std::string>& warnings() const noexcept { return warnings_; }

 private:
  DaemonBus() = default;
  static std::expected<std::unique_ptr<DaemonBus>, BusError> open_real(const std::string& name,
                                                                       const BusPlan& plan,
                                                                       Time spin);

  SentFrames sent_;
  std::optional<AnyPort> port_;
  std::optional<DiagnosticSocket> diagnostics_;
  std::vector<std::string> warnings_;
  std::unique_ptr<SimulatedBus> simulated_;
  std::variant<std::monostate, RecordedPort<SocketCanPort>, RecordedPort<UnixBusPort>,
               RecordedPort<SimulatedBus>>
      recorded_;
};

}  // namespace takt
