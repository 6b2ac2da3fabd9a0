#include <cerrno>
#include <cstring>
#include <linux/can.h>
#include <sys/socket.h>

#include "apps/takt/doctor/checkup.hpp"
#include "master/linux/file_descriptor.hpp"

namespace takt::doctor {
namespace {

constexpr std::uint32_t usual_bitrate = 1'000'000;
constexpr std::size_t usual_frames = 100;  // frames of a cycle with the outputs of fifty drives

std::string up_command(const std::string& name, std::uint32_t bitrate) {
  return "ip link set " + name + " up type can bitrate " + std::to_string(bitrate) +
         " restart-ms 100";
}

std::string bitrate_text(const CanLink& link) {
  if (!link.bitrate || *link.bitrate == 0) return "no bit rate";
  return std::to_string(*link.bitrate / 1000) + " kbit/s";
}

}  // namespace

Remark check_can_support() {
  const FileDescriptor socket{::socket(PF_CAN, SOCK_RAW | SOCK_CLOEXEC, CAN_RAW)};
  if (socket) return {Verdict::good, "SocketCAN", "the kernel supports it"};
  return {Verdict::bad, "SocketCAN",
          std::string{"no CAN sockets: "} + std::strerror(errno) +
              "; without SocketCAN only `--bus sim` and `--bus unix:PATH` work",
          "modprobe can-raw"};
}

std::vector<Remark> check_interface(const std::string& name, std::optional<std::uint32_t> bitrate) {
  const auto link = read_can_link(name);
  if (link) return judge_link(*link, bitrate);
  const std::string command =
      name.starts_with("vcan")
          ? "ip link add dev " + name + " type vcan && ip link set " + name + " up"
          : std::string{};
  return {{Verdict::bad, name,
           link.error().message.substr(name.size() + 2) +
               (command.empty() ? "; `ip -br link` lists the interfaces" : ""),
           command}};
}

std::vector<Remark> judge_link(const CanLink& link, std::optional<std::uint32_t> bitrate) {
  if (!link.is_can) return {{Verdict::bad, link.name, "is not a CAN interface"}};
  const bool has_bitrate = link.kind == "can";
  if (!link.up) {
    const std::string command =
        has_bitrate
            ? up_command(link.name, bitrate.value_or(link.bitrate.value_or(0) != 0 ? *link.bitrate
                                                                                   : usual_bitrate))
            : "ip link set " + link.name + " up";
    return {{Verdict::bad, link.name, "is down", command}};
  }
  std::vector<Remark> remarks;
  const std::uint32_t wanted = bitrate.value_or(link.bitrate.value_or(0));
  for (const std::string& warning : link_warnings(link, wanted, usual_frames)) {
    const std::size_t colon = warning.find(": ip link ");
    if (colon == std::string::npos) {
      remarks.push_back({Verdict::bad, link.name, warning});
    } else {
      remarks.push_back(
          {Verdict::bad, link.name, warning.substr(0, colon), warning.substr(colon + 2)});
    }
  }
  if (!remarks.empty()) return remarks;
  std::string text = "up, " + bitrate_text(link) + ", sends up to " +
                     std::to_string(link.tx_queue_length) + " frames at once";
  if (link.state) text += ", " + std::string{takt::name(*link.state)};
  return {{Verdict::good, link.name, text}};
}

}  // namespace takt::doctor
