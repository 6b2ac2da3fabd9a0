#pragma once
#include <cstdint>
#include <expected>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "master/linux/bus_error.hpp"

namespace takt {

/// State of a CAN controller as the driver reports it.
enum class CanState : std::uint8_t {
  error_active,
  error_warning,
  error_passive,
  bus_off,
  stopped,
  sleeping,
};
std::string_view name(CanState state) noexcept;

/// A CAN interface as the kernel describes it (`ip -details -statistics link show`). Properties
/// that a virtual interface lacks are absent.
struct CanLink {
  std::string name;
  std::string kind;  ///< "can", "vcan", "vxcan"; empty if the kernel does not name it
  bool is_can = false;
  bool up = false;
  std::uint32_t tx_queue_length = 0;  ///< frames
  std::optional<std::uint32_t> bitrate{};
  std::optional<std::uint32_t> restart_ms{};  ///< delay after bus-off; 0 means no automatic restart
  std::optional<CanState> state{};
  std::optional<std::uint16_t> tx_errors{};
  std::optional<std::uint16_t> rx_errors{};
  /// Number of bus-off events since the driver was loaded.
  std::optional<std::uint32_t> bus_off_count{};
  bool listen_only = false;
  std::uint64_t rx_frames = 0;
  std::uint64_t tx_frames = 0;
  std::uint64_t rx_dropped = 0;
};

/// Queries the kernel by netlink (RTM_GETLINK). Needs no privilege.
std::expected<CanLink, BusError> read_can_link(const std::string& interface);

/// Returns the command that changes a setting of an interface: `ip link set can0 down && ...`.
std::string link_command(const std::string& interface, const std::string& setting);

/// Lists what contradicts the network file or will cause trouble in operation, one sentence each
/// with the command that corrects it. Empty if there is nothing to report. `frames_a_cycle` is the
/// largest number of frames that the master sends at once.
std::vector<std::string> link_warnings(const CanLink& link, std::uint32_t bitrate,
                                       std::size_t frames_a_cycle);

}  // namespace takt
