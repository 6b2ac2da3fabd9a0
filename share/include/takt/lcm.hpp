#pragma once
/// @file
/// A connection to LCM, and the keys of a bus that accepts only signed commands. The message types
/// are those of share/lcm. lcm-gen makes one header for each, such as <takt/image_t.hpp>.
#include <array>
#include <cstddef>
#include <cstdint>
#include <expected>
#include <functional>
#include <memory>
#include <poll.h>
#include <span>
#include <string>
#include <string_view>
#include <vector>

namespace takt {

/// Takes one message that has arrived. `data` is valid only during the call.
using MessageHandler =
    std::function<void(std::string_view channel, std::span<const std::byte> data)>;

/// A way to exchange LCM messages: LCM itself, or either end of its tcpq protocol. All calls come
/// from one thread, and no call waits. open_lcm() makes one.
class Transport {
 public:
  virtual ~Transport() = default;

  /// Sends one encoded message. Returns false if the message is lost.
  virtual bool publish(const std::string& channel, std::span<const std::byte> data) = 0;
  /// Returns true if anybody receives this channel, or if that is not known.
  virtual bool wanted(std::string_view channel) const {
    static_cast<void>(channel);
    return true;
  }
  /// Subscribes to channels. `pattern` is a regular expression over whole channel names.
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
  /// Returns the URL that another program sets to reach this transport: "tcpq://127.0.0.1:7700".
  virtual std::string url() const = 0;
};

/// Opens the connection of an application to LCM. The address is `url`; if that is empty, it is the
/// environment variable LCM_DEFAULT_URL, or else the default of LCM. If multicast is impossible on
/// this machine, the connection goes to the hub that taktd then serves on the loopback interface
/// (tcpq://127.0.0.1). On failure, returns a sentence for the user.
std::expected<std::unique_ptr<Transport>, std::string> open_lcm(const std::string& url);

/// A secret shared by senders and the daemon, with the name that signed messages carry.
struct EnvelopeKey {
  static constexpr std::size_t bytes = 32;  ///< length of a secret

  std::string name;                          ///< name of the key
  std::array<std::uint8_t, bytes> secret{};  ///< the secret
};

/// Reads the keys of a file that `takt keys new` has made: each line holds a name and 64 hex
/// digits, and `#` begins a comment. The file must be a regular file that only its owner can
/// access, and the owner must be this user or root. On failure, returns a sentence for the user.
std::expected<std::vector<EnvelopeKey>, std::string> load_keys(const std::string& path);

}  // namespace takt
