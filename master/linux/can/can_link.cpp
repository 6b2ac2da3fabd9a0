#include "master/linux/can/can_link.hpp"

#include <array>
#include <cerrno>
#include <cstring>
#include <linux/can/netlink.h>
#include <linux/if.h>
#include <linux/if_arp.h>
#include <linux/if_link.h>
#include <linux/rtnetlink.h>
#include <sys/socket.h>

#include "eds_parser/values/name_of.hpp"
#include "master/linux/file_descriptor.hpp"

namespace takt {
namespace {

template <class T>
std::optional<T> value_of(const rtattr* attribute) {
  if (attribute == nullptr || RTA_PAYLOAD(attribute) < sizeof(T)) return std::nullopt;
  T value;
  std::memcpy(&value, RTA_DATA(attribute), sizeof value);
  return value;
}

/// Returns the attributes of one nesting level, indexed by their number.
template <std::size_t N>
std::array<const rtattr*, N> table_of(const rtattr* first, std::size_t bytes) {
  std::array<const rtattr*, N> table{};
  auto rest = static_cast<unsigned>(bytes);
  for (auto* a = const_cast<rtattr*>(first); RTA_OK(a, rest); a = RTA_NEXT(a, rest)) {
    const unsigned type = a->rta_type & NLA_TYPE_MASK;
    if (type < N) table[type] = a;
  }
  return table;
}

template <std::size_t N>
std::array<const rtattr*, N> nested(const rtattr* attribute) {
  if (attribute == nullptr) return {};
  return table_of<N>(static_cast<const rtattr*>(RTA_DATA(attribute)), RTA_PAYLOAD(attribute));
}

std::string text_of(const rtattr* attribute) {
  if (attribute == nullptr) return {};
  const auto* text = static_cast<const char*>(RTA_DATA(attribute));
  return {text, strnlen(text, RTA_PAYLOAD(attribute))};
}

void read_can_data(const rtattr* data, CanLink& link) {
  const auto can = nested<IFLA_CAN_MAX + 1>(data);
  if (const auto timing = value_of<can_bittiming>(can[IFLA_CAN_BITTIMING])) {
    link.bitrate = timing->bitrate;
  }
  link.restart_ms = value_of<std::uint32_t>(can[IFLA_CAN_RESTART_MS]);
  if (const auto state = value_of<std::uint32_t>(can[IFLA_CAN_STATE]); state && *state <= 5) {
    link.state = static_cast<CanState>(*state);
  }
  if (const auto errors = value_of<can_berr_counter>(can[IFLA_CAN_BERR_COUNTER])) {
    link.tx_errors = errors->txerr;
    link.rx_errors = errors->rxerr;
  }
  if (const auto mode = value_of<can_ctrlmode>(can[IFLA_CAN_CTRLMODE])) {
    link.listen_only = (mode->flags & CAN_CTRLMODE_LISTENONLY) != 0;
  }
}

CanLink link_of(const nlmsghdr& message) {
  const auto* info = static_cast<const ifinfomsg*>(NLMSG_DATA(&message));
  const auto link = table_of<IFLA_MAX + 1>(IFLA_RTA(info), IFLA_PAYLOAD(&message));
  CanLink out;
  out.name = text_of(link[IFLA_IFNAME]);
  out.is_can = info->ifi_type == ARPHRD_CAN;
  out.up = (info->ifi_flags & IFF_UP) != 0;
  out.tx_queue_length = value_of<std::uint32_t>(link[IFLA_TXQLEN]).value_or(0);
  if (const auto counts = value_of<rtnl_link_stats64>(link[IFLA_STATS64])) {
    out.rx_frames = counts->rx_packets;
    out.tx_frames = counts->tx_packets;
    out.rx_dropped = counts->rx_dropped + counts->rx_over_errors;
  }
  const auto description = nested<IFLA_INFO_MAX + 1>(link[IFLA_LINKINFO]);
  out.kind = text_of(description[IFLA_INFO_KIND]);
  if (out.kind == "can") {
    read_can_data(description[IFLA_INFO_DATA], out);
    if (const auto counts = value_of<can_device_stats>(description[IFLA_INFO_XSTATS])) {
      out.bus_off_count = counts->bus_off;
    }
  }
  return out;
}

}  // namespace

std::string_view name(CanState state) noexcept {
  static constexpr std::string_view names[]{"error-active", "error-warning", "error-passive",
                                            "bus-off",      "stopped",       "sleeping"};
  return name_of(state, names, "unknown");
}

std::expected<CanLink, BusError> read_can_link(const std::string& interface) {
  const auto refuse = [&interface](int error) {
    return std::unexpected{BusError{interface + ": " + std::strerror(error), error}};
  };
  struct {
    nlmsghdr header;
    ifinfomsg info;
    rtattr name_head;
    char name[IFNAMSIZ];
  } request{};
  if (interface.empty() || interface.size() >= IFNAMSIZ) return refuse(EINVAL);
  interface.copy(request.name, interface.size());
  request.name_head.rta_type = IFLA_IFNAME;
  request.name_head.rta_len = RTA_LENGTH(IFNAMSIZ);
  request.header.nlmsg_len = sizeof request;
  request.header.nlmsg_type = RTM_GETLINK;
  request.header.nlmsg_flags = NLM_F_REQUEST;

  const FileDescriptor socket{::socket(AF_NETLINK, SOCK_RAW | SOCK_CLOEXEC, NETLINK_ROUTE)};
  alignas(nlmsghdr) std::array<char, 16384> answer;
  if (!socket || send(socket.get(), &request, sizeof request, 0) < 0) return refuse(errno);
  const ssize_t got = recv(socket.get(), answer.data(), answer.size(), 0);
  if (got < 0) return refuse(errno);
  const auto* message = reinterpret_cast<const nlmsghdr*>(answer.data());
  if (!NLMSG_OK(message, static_cast<std::size_t>(got))) return refuse(EPROTO);
  if (message->nlmsg_type == NLMSG_ERROR) {
    return refuse(-static_cast<const nlmsgerr*>(NLMSG_DATA(message))->error);
  }
  if (message->nlmsg_type != RTM_NEWLINK) return refuse(EPROTO);
  return link_of(*message);
}

std::string link_command(const std::string& interface, const std::string& setting) {
  return "ip link set " + interface + " down && ip link set " + interface + " up type can " +
         setting;
}

std::vector<std::string> link_warnings(const CanLink& link, std::uint32_t bitrate,
                                       std::size_t frames_a_cycle) {
  std::vector<std::string> out;
  const auto& n = link.name;
  if (link.bitrate && *link.bitrate != bitrate) {
    out.push_back(n + " runs at " + std::to_string(*link.bitrate / 1000) +
                  " kbit/s, but the network file says " + std::to_string(bitrate / 1000) + ": " +
                  link_command(n, "bitrate " + std::to_string(bitrate)));
  }
  const std::size_t room = frames_a_cycle + 16;  // service frames in addition to the outputs
  if (link.tx_queue_length != 0 && link.tx_queue_length < room) {
    out.push_back(n + " has a send queue of " + std::to_string(link.tx_queue_length) +
                  " frames, but a cycle may send " + std::to_string(room) + ": ip link set " + n +
                  " txqueuelen " + std::to_string(room < 128 ? 128 : room));
  }
  if (link.restart_ms && *link.restart_ms == 0) {
    out.push_back(n + " does not restart after a bus-off: " + link_command(n, "restart-ms 100"));
  }
  if (link.listen_only) {
    out.push_back(n + " is in listen-only mode: " + link_command(n, "listen-only off"));
  }
  if (link.state == CanState::bus_off || link.state == CanState::error_passive) {
    out.push_back(n + " is " + std::string{name(*link.state)} +
                  ": check the bit rate of all devices, the termination and the cable");
  }
  return out;
}

}  // namespace takt
