#pragma once
#include <expected>
#include <memory>
#include <poll.h>
#include <string>
#include <vector>

#include "master/gateway/ascii_gateway.hpp"
#include "master/gateway/ascii_server.hpp"
#include "master/gateway/bridge.hpp"
#include "master/master.hpp"

namespace takt {

/// The CiA 309-3 gateway of a daemon: clients of a socket, and the master behind it. Front thread.
class AsciiFront {
 public:
  /// Listens on `unix:PATH` or `tcp:PORT`. `plan` outlives it. An error is a sentence.
  static std::expected<std::unique_ptr<AsciiFront>, std::string> open(const std::string& where,
                                                                      const BusPlan& plan);
  AsciiFront(const AsciiFront&) = delete;
  AsciiFront& operator=(const AsciiFront&) = delete;

  /// Before the first serve(); both outlive it.
  void attach(Master& master, Bridge& bridge);
  void serve();
  void watch(std::vector<pollfd>& descriptors) const { server_->watch(descriptors); }
  const std::string& where() const noexcept { return server_->where(); }

 private:
  explicit AsciiFront(const BusPlan& plan);

  Master* master_ = nullptr;
  Bridge* bridge_ = nullptr;
  AsciiGateway gateway_;
  std::unique_ptr<AsciiServer> server_;
  std::uint64_t gaps_ = 0;  // of the bridge, that were heard of
};

}  // namespace takt
