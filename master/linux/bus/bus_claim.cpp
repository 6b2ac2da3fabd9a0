#include "master/linux/bus/bus_claim.hpp"

#include <array>
#include <cerrno>
#include <cstddef>
#include <cstdint>
#include <cstring>
#include <filesystem>
#include <fstream>
#include <net/if.h>
#include <sys/socket.h>
#include <sys/un.h>
#include <utility>

namespace takt {
namespace {

struct Address {
  sockaddr_un name{};
  socklen_t size = 0;
  const sockaddr* generic() const noexcept { return reinterpret_cast<const sockaddr*>(&name); }
};

/// Returns the kernel's name of an interface, which may be given by an alternative name.
std::string real_interface(const std::string& name) {
  std::array<char, IF_NAMESIZE> real{};
  const unsigned index = ::if_nametoindex(name.c_str());
  const bool known = index != 0 && ::if_indextoname(index, real.data()) != nullptr;
  return known ? real.data() : name;
}

/// Returns the absolute path without symbolic links, also of a file that does not exist yet.
std::string real_path(const std::string& path) {
  std::error_code error;
  const auto absolute = std::filesystem::absolute(path, error);
  if (error) return path;
  const auto real = std::filesystem::weakly_canonical(absolute, error);
  return error ? absolute.string() : real.string();
}

/// Returns an FNV-1a hash, for paths that are longer than the name of a socket may be.
std::string hash(const std::string& text) {
  std::uint64_t value = 0xCBF2'9CE4'8422'2325;
  for (const char letter : text) {
    value = (value ^ static_cast<unsigned char>(letter)) * 0x100'0000'01B3;
  }
  return std::to_string(value);
}

/// Builds an abstract address: the name begins with a zero byte and is not a file.
Address address_of(const BusName& bus) {
  const bool interface = bus.kind == BusName::Kind::can_interface;
  std::string name = interface ? real_interface(bus.name) : "unix:" + real_path(bus.name);
  Address address;
  const std::string prefix = "takt/master/";
  const std::size_t room = sizeof address.name.sun_path - 1 - prefix.size();
  if (name.size() > room) name = "unix:" + hash(name);
  name = prefix + name;
  address.name.sun_family = AF_UNIX;
  std::memcpy(address.name.sun_path + 1, name.data(), name.size());
  address.size = static_cast<socklen_t>(offsetof(sockaddr_un, sun_path) + 1 + name.size());
  return address;
}

/// Returns "process 1234 (taktd)", as far as this process can find out.
std::string holder_of(const Address& address) {
  const FileDescriptor socket{::socket(AF_UNIX, SOCK_STREAM | SOCK_NONBLOCK | SOCK_CLOEXEC, 0)};
  ucred holder{};
  socklen_t size = sizeof holder;
  if (::connect(socket.get(), address.generic(), address.size) != 0 ||
      ::getsockopt(socket.get(), SOL_SOCKET, SO_PEERCRED, &holder, &size) != 0 || holder.pid <= 0) {
    return "another process";
  }
  std::string text = "process " + std::to_string(holder.pid);
  std::string program;
  std::getline(std::ifstream{"/proc/" + std::to_string(holder.pid) + "/comm"}, program);
  return program.empty() ? text : text + " (" + program + ")";
}

std::string text_of(const BusName& bus) {
  return bus.kind == BusName::Kind::unix_path ? "unix:" + bus.name : bus.name;
}

}  // namespace

std::expected<BusClaim, BusError> BusClaim::take(const BusName& bus) {
  if (bus.kind == BusName::Kind::simulated) return BusClaim{FileDescriptor{}};
  const Address address = address_of(bus);
  FileDescriptor socket{::socket(AF_UNIX, SOCK_STREAM | SOCK_NONBLOCK | SOCK_CLOEXEC, 0)};
  if (socket && ::bind(socket.get(), address.generic(), address.size) == 0 &&
      ::listen(socket.get(), 16) == 0) {
    return BusClaim{std::move(socket)};
  }
  const int error = errno;
  if (error != EADDRINUSE) {
    return std::unexpected{BusError{
        text_of(bus) + ": takt can't lock the bus for one master: " + std::strerror(error), error}};
  }
  return std::unexpected{BusError{text_of(bus) + ": " + holder_of(address) +
                                      " is the master of this bus already; end that process first, "
                                      "or only listen with --observe",
                                  error}};
}

}  // namespace takt
