#pragma once
#include <expected>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "eds_parser/table/time.hpp"
#include "master/gateway/key_file.hpp"
#include "master/gateway/transport.hpp"

namespace takt {

/// A program's side of LCM. Where nobody names a URL it listens where a daemon can be: LCM's
/// multicast and the tcpq:// hub on loopback that taktd opens where there is no multicast.
class LcmClient {
 public:
  /// `url` empty: LCM_DEFAULT_URL, else both of the above. An error is a sentence.
  /// `signers`: only what somebody has signed with one of these keys is heard, see
  /// CheckedTransport.
  static std::expected<LcmClient, std::string> open(
      const std::string& url, const std::vector<std::string>& patterns,
      const std::optional<WatchedKeyFile>& signers = std::nullopt);

  void publish(const std::string& channel, std::span<const std::byte> data);
  /// Hands over what arrives until `until`, at the latest, or until one round brought something.
  /// `also` is watched too (-1: nothing): a terminal, a timer.
  void serve(const MessageHandler& handler, Time until, int also = -1);
  /// Where it listens: "udpm://239.255.76.67:7667?ttl=0 and tcpq://127.0.0.1:7700".
  std::string where() const;

 private:
  std::vector<std::unique_ptr<Transport>> transports_;
};

}  // namespace takt
