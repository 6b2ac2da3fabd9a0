#pragma once
#include <cstddef>
#include <functional>
#include <poll.h>
#include <span>
#include <string>
#include <string_view>
#include <vector>

namespace takt {

/// Takes one message that has arrived.
using MessageHandler =
    std::function<void(std::string_view channel, std::span<const std::byte> data)>;

/// A way to exchange LCM messages: LCM itself, or either end of its tcpq protocol. One thread; no
/// call waits.
class Transport {
 public:
  virtual ~Transport() = default;

  /// Returns false if the message is lost.
  virtual bool publish(const std::string& channel, std::span<const std::byte> data) = 0;
  /// Returns true if anybody receives this channel, or if that is not known.
  virtual bool wanted(std::string_view channel) const {
    static_cast<void>(channel);
    return true;
  }
  /// `pattern` is a regular expression over whole channel names.
  virtual void subscribe(const std::string& pattern) = 0;
  /// Does the work that has become possible and hands over the messages that have arrived.
  virtual void serve(const MessageHandler& handler) = 0;
  /// Returns false if the newest serve() has left messages that had arrived, because its time
  /// budget has ended.
  virtual bool drained() const { return true; }
  /// Adds the descriptors that poll() must watch to know when serve() has work.
  virtual void watch(std::vector<pollfd>& descriptors) const = 0;
  /// Returns false if the transport has failed for good and should be replaced.
  virtual bool good() const = 0;
  /// The URL that another program sets to reach this transport: "tcpq://127.0.0.1:7700".
  virtual std::string url() const = 0;
};

}  // namespace takt
