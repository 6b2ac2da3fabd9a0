#pragma once
#include <chrono>
#include <expected>
#include <functional>
#include <future>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "eds_parser/table/run_options.hpp"
#include "master/gateway/lcm_transport.hpp"
#include "master/gateway/lcm_url.hpp"
#include "master/gateway/transport.hpp"

namespace takt {

/// The daemon's connection to LCM, whatever the machine allows: LCM's own multicast, the tcpq://
/// hub that the URL names, or a hub of our own. It works or it is tried again; nothing here waits,
/// since the bus has to run on. Where the port of our own hub is taken, whoever has it may be
/// anybody: we become the client of a hub only where a URL says so. Front thread.
class LcmLink final : public Transport {
 public:
  using Say = std::function<void(const std::string& sentence)>;

  /// `say` hears what people have to know: which URL to set, what is missing. All `patterns` are
  /// subscribed from the start.
  LcmLink(LcmUrl url, bool broker, std::vector<std::string> patterns, Say say);

  bool publish(const std::string& channel, std::span<const std::byte> data) override;
  bool wanted(std::string_view channel) const override;
  void subscribe(const std::string& pattern) override;
  void serve(const MessageHandler& handler) override;
  void watch(std::vector<pollfd>& descriptors) const override;
  bool good() const override { return true; }
  /// What other programs set; empty while there is no connection.
  std::string url() const override;

 private:
  void open_tcpq(const LcmUrl& url);
  void begin_hub();
  bool serve_hub(std::uint16_t port);
  void try_again();
  void tell_once(const std::string& sentence);
  void begin_lcm();
  void finish_lcm();
  void fall_back(const std::string& why);
  void use(std::unique_ptr<Transport> transport);

  LcmUrl url_;
  bool broker_;
  Say say_;
  std::string told_;  // the newest sentence that is not repeated with each try
  std::vector<std::string> patterns_;
  std::unique_ptr<Transport> main_;      // what the URL asks for
  std::unique_ptr<Transport> fallback_;  // the hub, where the URL could not be had
  std::future<std::unique_ptr<LcmTransport>> opening_;
  std::chrono::steady_clock::time_point next_try_{};
};

}  // namespace takt
