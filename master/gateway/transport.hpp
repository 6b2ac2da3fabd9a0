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

/// A way to exchange LCM messages: LCM itself, or its tcpq protocol from either end. One thread;
/// no call waits.
class Transport {
 public:
  virtual ~Transport() = default;

  /// False: the message is lost.
  virtual bool publish(const std::string& channel, std::span<const std::byte> data) = 0;
  /// Whether anybody hears this channel; true where that is not known.
  virtual bool wanted(std::string_view channel) const {
    static_cast<void>(channel);
    return true;
  }
  /// `pattern` is a regular expression over whole channel names.
  virtual void subscribe(const std::string& pattern) = 0;
  /// Does what has become possible, hands over what has arrived.
  virtual void serve(const MessageHandler& handler) = 0;
  /// Adds what poll() has to watch so that serve() is worth calling.
  virtual void watch(std::vector<pollfd>& descriptors) const = 0;
  /// False: it has failed for good and should be replaced.
  virtual bool good() const = 0;
  /// What another program sets to get here: "tcpq://127.0.0.1:7700".
  virtual std::string url() const = 0;
};

}  // namespace takt
