#pragma once
#include <expected>
#include <functional>
#include <optional>
#include <string>
#include <takt/reply_t.hpp>
#include <takt/request_t.hpp>
#include <takt/status_t.hpp>
#include <utility>
#include <vector>

#include "apps/takt/live_arguments.hpp"
#include "master/gateway/bus_view.hpp"
#include "master/gateway/envelope.hpp"
#include "master/gateway/lcm_client.hpp"

namespace takt {

/// Why there is no answer, and the exit code that says so.
struct LiveError {
  std::string sentence;
  int code = 3;
  std::uint32_t abort_code = 0;  ///< of an SDO transfer; 0: none
};

/// A running daemon, found by its status messages.
class DaemonClient {
 public:
  /// Waits until status of a bus has come (for the one that `options` name, if they name one);
  /// several buses without a choice are an error.
  static std::expected<DaemonClient, LiveError> find(const LiveOptions& options);

  const status_t& status() const noexcept { return status_; }
  /// Id of a node given as number or name; 0 for "all".
  std::expected<std::int16_t, LiveError> node(const std::string& text) const;

  /// Sends a request and waits for its answer. `limit` is beyond what the daemon itself waits.
  std::expected<reply_t, LiveError> ask(request_t request, Time limit);

  /// Sends a message on the channel BUS_WHAT, in an envelope where there is a key.
  void send(std::string_view what, Bytes message);
  /// For dialogues of more than one message: what arrives.
  LcmClient& lcm() noexcept { return lcm_; }

 private:
  DaemonClient(LcmClient lcm, status_t status, std::optional<EnvelopeSeal> seal)
      : lcm_{std::move(lcm)}, status_{std::move(status)}, seal_{std::move(seal)} {}

  LcmClient lcm_;
  status_t status_;
  std::optional<EnvelopeSeal> seal_;  // none: no keys
};

/// LCM as these options say. The error has an exit code.
std::expected<LcmClient, LiveError> open_live(const LiveOptions& options,
                                              const std::vector<std::string>& patterns);

/// The buses of which status has come: the one that is called so, also in capitals, or all.
std::vector<const BusView*> chosen(const BusViews& views, const std::string& bus_name);

/// Why there is none of them: what others there are, or where no daemon answers and what to try.
LiveError no_bus(const BusViews& views, const LcmClient& lcm, const std::string& bus_name);

/// None: each bus has one.
std::optional<LiveError> two_daemons(const std::vector<const BusView*>& buses);

/// Feeds `views` until `enough` says so, at the latest until `until` (monotonic).
void listen(LcmClient& lcm, BusViews& views, Time until, const std::function<bool()>& enough);

}  // namespace takt
