#pragma once
#include <deque>
#include <functional>
#include <optional>
#include <string>
#include <takt/lcm.hpp>
#include <vector>

#include "master/lcm/clocks.hpp"
#include "master/lcm/envelope/envelope.hpp"
#include "master/lcm/envelope/key_file.hpp"
#include "master/lcm/rate_limit.hpp"

namespace takt {

/// The transport of a daemon with keys: commands, requests and transfers are accepted in envelopes
/// only. It reads a changed key file again within a second. All calls come from one thread.
class SecuredTransport final : public Transport {
 public:
  struct Options {
    std::string bus;
    std::int64_t session = 0;
    std::vector<std::string> guarded;  ///< channels that require an envelope
    bool signs = false;  ///< published messages also go out on BUS_SIGNED, in envelopes
    /// Receives the reasons of refusals, at most once per second for the same reason.
    std::function<void(const std::string& sentence)> say;
  };

  /// `inner` must have subscribed BUS_SECURED. `inner` and `clocks` must outlive this object.
  SecuredTransport(Transport& inner, const Clocks& clocks, WatchedKeyFile keys, Options options);

  bool publish(const std::string& channel, std::span<const std::byte> data) override;
  bool wanted(std::string_view channel) const override { return inner_.wanted(channel); }
  void subscribe(const std::string& pattern) override { inner_.subscribe(pattern); }
  void serve(const MessageHandler& handler) override;
  bool drained() const override { return inner_.drained(); }
  void watch(std::vector<pollfd>& descriptors) const override { inner_.watch(descriptors); }
  bool good() const override { return inner_.good(); }
  std::string url() const override { return inner_.url(); }

 private:
  using Octets = std::vector<std::byte>;

  void take(std::string_view channel, Bytes data, const MessageHandler& handler);
  bool is_guarded(std::string_view channel) const noexcept;
  bool is_echo(Bytes envelope, Time now);
  void refuse(const std::string& what);
  void reread_keys(Time now);
  void use_keys();

  Transport& inner_;
  const Clocks& clocks_;
  WatchedKeyFile keys_;
  Options options_;
  std::string secured_channel_;
  std::string signed_channel_;
  std::optional<EnvelopeSeal> seal_;  // empty if nothing is signed
  EnvelopeGuard guard_;
  RateLimit reported_{std::chrono::seconds{1}};
  Time next_look_{};
  struct Opened {
    Octets mac;
    Time when{};
  };
  std::deque<Opened> opened_;  // envelopes that were opened within the last 50 ms
};

}  // namespace takt
