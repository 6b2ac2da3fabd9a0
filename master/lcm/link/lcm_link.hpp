#pragma once
#include <chrono>
#include <cstdint>
#include <expected>
#include <functional>
#include <future>
#include <memory>
#include <string>
#include <takt/lcm.hpp>
#include <vector>

#include "eds_parser/table/run_options.hpp"
#include "master/lcm/link/lcm_transport.hpp"
#include "master/lcm/link/lcm_url.hpp"
#include "master/lcm/weight.hpp"

namespace takt {

class TcpqBroker;

/// The connection of the daemon to LCM: by LCM's multicast, by the tcpq:// hub that the URL names,
/// or by a hub of its own if the machine allows nothing else. The link retries a connection that
/// fails and never blocks, because the front thread must not stop. If another program holds the
/// port of the daemon's hub, nothing is known about that program. The daemon therefore becomes the
/// client of a foreign hub only if a URL names this hub. All calls come from the front thread.
class LcmLink final : public Transport {
 public:
  using Say = std::function<void(Weight weight, const std::string& sentence)>;

  /// The hub that the daemon uses if the URL begins with tcpq://.
  enum class Hub : std::uint8_t {
    own,             ///< only the hub of the daemon
    named,           ///< the hub that the command line or the network file names
    by_environment,  ///< the hub that LCM_DEFAULT_URL names; a warning reports this
  };

  /// `say` receives what users must know: which URL to set, or what is missing. All `patterns` are
  /// subscribed from the start.
  LcmLink(LcmUrl url, Hub hub, std::vector<std::string> patterns, Say say);

  bool publish(const std::string& channel, std::span<const std::byte> data) override;
  bool wanted(std::string_view channel) const override;
  void subscribe(const std::string& pattern) override;
  void serve(const MessageHandler& handler) override;
  bool drained() const override;
  void watch(std::vector<pollfd>& descriptors) const override;
  bool good() const override { return true; }
  /// Returns the URL that other programs must set; empty while there is no connection.
  std::string url() const override;

 private:
  void open_tcpq(const LcmUrl& url);
  void begin_hub();
  std::expected<std::unique_ptr<TcpqBroker>, int> listen(std::uint16_t port);
  bool serve_hub(std::uint16_t port);
  void try_again();
  void warn_once(const std::string& sentence);
  void begin_lcm();
  void finish_lcm();
  void fall_back(const std::string& why);
  void use(std::unique_ptr<Transport> transport);

  LcmUrl url_;
  Hub hub_;
  Say say_;
  std::string reported_;  // the newest sentence that each retry would repeat
  std::vector<std::string> patterns_;
  std::unique_ptr<Transport> main_;      // the transport that the URL names
  std::unique_ptr<Transport> fallback_;  // the hub in use while the URL cannot be used
  std::future<std::unique_ptr<LcmTransport>> opening_;
  std::chrono::steady_clock::time_point next_try_{};
};

}  // namespace takt
