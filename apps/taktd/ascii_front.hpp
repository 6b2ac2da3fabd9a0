#pragma once
#include <expected>
#include <functional>
#include <memory>
#include <poll.h>
#include <string>
#include <vector>

#include "master/gateway/ascii/ascii_gateway.hpp"
#include "master/gateway/ascii/ascii_server.hpp"
#include "master/gateway/bridge.hpp"
#include "master/master_run.hpp"

namespace takt {

/// Connects the clients of a socket to the master through the CiA 309-3 gateway. Used only by the
/// front thread.
class AsciiFront {
 public:
  /// Listens on `unix:PATH` or `tcp:PORT`. `plan` must outlive the AsciiFront. `warn`
  /// receives messages on later failures of the socket. The error is a sentence for the user.
  static std::expected<std::unique_ptr<AsciiFront>, std::string> open(
      const std::string& where, const BusPlan& plan,
      std::function<void(const std::string& sentence)> warn);
  AsciiFront(const AsciiFront&) = delete;
  AsciiFront& operator=(const AsciiFront&) = delete;

  /// Call this before the first serve(). `master` and `bridge` must outlive the AsciiFront.
  void attach(MasterRun& master, Bridge& bridge);
  void serve();
  void watch(std::vector<pollfd>& descriptors) const { server_->watch(descriptors); }
  const std::string& where() const noexcept { return server_->where(); }

 private:
  explicit AsciiFront(const BusPlan& plan);

  MasterRun* master_ = nullptr;
  Bridge* bridge_ = nullptr;
  AsciiGateway gateway_;
  std::unique_ptr<AsciiServer> server_;
  std::uint64_t gaps_ = 0;       // value of Bridge::gaps() at the last serve()
  std::uint64_t long_gaps_ = 0;  // value of Bridge::long_gaps() at the last serve()
};

}  // namespace takt
