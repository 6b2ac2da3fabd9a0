#include "apps/takt/interface_bitrate.hpp"

#include <array>
#include <spawn.h>
#include <sys/wait.h>
#include <unistd.h>
#include <vector>

#include "master/linux/bus_name.hpp"
#include "master/linux/can_link.hpp"

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

}  // namespace

std::string set_interface_bitrate(const std::string& bus, int bitrate) {
  const BusName name = BusName::parse(bus);
  if (name.kind != BusName::Kind::can_interface) return {};
  const auto link = read_can_link(std::string{name.name});
  if (!link || link->kind != "can") return {};
  const std::string rate = std::to_string(bitrate);
  const std::string& interface = link->name;
  const bool done = run({"ip", "link", "set", interface, "down"}) &&
                    run({"ip", "link", "set", interface, "type", "can", "bitrate", rate}) &&
                    run({"ip", "link", "set", interface, "up"});
  if (done) return {};
  return "the devices change to " + rate + " bit/s, but " + interface +
         " could not: as root, ip link set " + interface + " down && ip link set " + interface +
         " up type can bitrate " + rate;
}

}  // namespace takt
