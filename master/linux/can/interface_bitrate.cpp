#include "master/linux/can/interface_bitrate.hpp"

#include <optional>
#include <spawn.h>
#include <sys/wait.h>
#include <unistd.h>
#include <vector>

#include "master/linux/bus_name.hpp"

namespace takt {
namespace {

bool run(std::vector<std::string> words) {
  std::vector<char*> arguments;
  for (std::string& word : words) arguments.push_back(word.data());
  arguments.push_back(nullptr);
  pid_t child = 0;
  if (::posix_spawnp(&child, arguments[0], nullptr, nullptr, arguments.data(), environ) != 0) {
    return false;
  }
  int status = 0;
  return ::waitpid(child, &status, 0) == child && WIFEXITED(status) && WEXITSTATUS(status) == 0;
}

/// Returns std::nullopt for a bus without a bit rate.
std::optional<CanLink> link_of(const std::string& bus) {
  const BusName name = BusName::parse(bus);
  if (name.kind != BusName::Kind::can_interface) return {};
  const auto link = read_can_link(std::string{name.name});
  return link ? std::optional{*link} : std::nullopt;
}

}  // namespace

std::string interface_bitrate_error(const CanLink& link) {
  if (link.kind != "can") return {};
  const std::string length = std::to_string(link.tx_queue_length);  // the current length
  if (run({"ip", "link", "set", link.name, "txqueuelen", length})) return {};
  return "the bit rate of " + link.name +
         " can't be changed (ip link needs root, or CAP_NET_ADMIN); no device was changed";
}

std::string interface_bitrate_error(const std::string& bus) {
  const auto link = link_of(bus);
  return link ? interface_bitrate_error(*link) : std::string{};
}

std::string set_interface_bitrate(const std::string& bus, int bitrate) {
  const auto link = link_of(bus);
  if (!link || link->kind != "can") return {};
  const std::string rate = std::to_string(bitrate);
  const std::string& interface = link->name;
  const bool done = run({"ip", "link", "set", interface, "down"}) &&
                    run({"ip", "link", "set", interface, "type", "can", "bitrate", rate}) &&
                    run({"ip", "link", "set", interface, "up"});
  if (done) return {};
  return "the devices change to " + rate + " bit/s, but " + interface +
         " could not change: as root, " + link_command(interface, "bitrate " + rate);
}

}  // namespace takt
