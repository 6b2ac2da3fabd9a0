#include <fstream>

#include "apps/takt/doctor/checkup.hpp"
#include "master/lcm/link/lcm_url.hpp"

namespace takt::doctor {
namespace {

constexpr std::uint64_t wanted_buffer = 2 << 20;  // bytes, the size that LCM requests

Remark check_route(const LcmUrl& url) {
  if (url.scheme != "udpm") return {Verdict::good, "LCM", url.text + " needs no multicast"};
  const std::string obstacle = multicast_obstacle(url);
  if (obstacle.empty())
    return {Verdict::good, "LCM", "multicast to " + url.address + " has a route"};
  const bool no_route = obstacle.find("no multicast route") != std::string::npos;
  return {Verdict::hint, "LCM",
          (no_route ? std::string{"no multicast route"} : obstacle) +
              "; taktd serves tcpq://127.0.0.1:7700 instead",
          no_route ? "ip link set lo multicast on && ip route add 224.0.0.0/4 dev lo" : ""};
}

Remark check_buffer(const std::filesystem::path& root) {
  std::ifstream file{root / "proc/sys/net/core/rmem_max"};
  std::uint64_t bytes = 0;
  if (!(file >> bytes)) return {Verdict::good, "socket buffers", "unknown"};
  if (bytes >= wanted_buffer) {
    return {Verdict::good, "socket buffers", "up to " + std::to_string(bytes >> 10U) + " KiB"};
  }
  return {Verdict::hint, "socket buffers",
          "at most " + std::to_string(bytes >> 10U) + " KiB: bursts of messages may be lost",
          "sysctl -w net.core.rmem_max=2097152"};
}

}  // namespace

std::vector<Remark> check_lcm(const std::string& url, const std::filesystem::path& root) {
  const auto parsed = parse_lcm_url(url);
  if (!parsed) return {{Verdict::bad, "LCM", parsed.error()}};
  std::vector<Remark> remarks{check_route(*parsed)};
  if (parsed->scheme == "udpm") remarks.push_back(check_buffer(root));
  return remarks;
}

}  // namespace takt::doctor
