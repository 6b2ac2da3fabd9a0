#pragma once
#include <expected>
#include <memory>
#include <optional>
#include <string>
#include <takt/lcm.hpp>
#include <vector>

#include "eds_parser/values/time.hpp"
#include "master/lcm/envelope/key_file.hpp"

namespace takt {

/// The connection of a program to LCM. Without a URL, it listens at both places where a daemon may
/// publish: on LCM's multicast, and at the tcpq:// hub on loopback, which taktd opens if there is
/// no multicast.
class LcmClient {
 public:
  /// If `url` is empty, LCM_DEFAULT_URL applies. If this is not set either, the client uses both
  /// places. With `signers`, the client accepts only messages that are signed with one of these
  /// keys, see CheckedTransport. The error is a sentence.
  static std::expected<LcmClient, std::string> open(
      const std::string& url, const std::vector<std::string>& patterns,
      const std::optional<WatchedKeyFile>& signers = std::nullopt);

  void publish(const std::string& channel, std::span<const std::byte> data);
  /// Passes arriving messages to `handler`. Returns at `until`, or after the first round that has
  /// brought a message. Also returns when the descriptor `also` has input, such as a terminal or a
  /// timer (-1 for none).
  void serve(const MessageHandler& handler, Time until, int also = -1);
  /// Addresses of the transports: "udpm://239.255.76.67:7667?ttl=0 and tcpq://127.0.0.1:7700".
  std::string where() const;

 private:
  std::vector<std::unique_ptr<Transport>> transports_;
};

}  // namespace takt
