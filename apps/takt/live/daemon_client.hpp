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

#include "apps/command_line/live_arguments.hpp"
#include "master/gateway/message/bus_view.hpp"
#include "master/lcm/envelope/envelope.hpp"
#include "master/lcm/link/lcm_client.hpp"

namespace takt {

/// The reason why there is no answer, and the exit code for it.
struct LiveError {
  std::string sentence;
  int code = 3;
  std::uint32_t abort_code = 0;  ///< SDO abort code; 0 means none
};

/// A running daemon, found by its status messages.
class DaemonClient {
 public:
  /// Waits until a status of a bus has come, or of the bus that `options` name. Several buses
  /// without a choice are an error.
  static std::expected<DaemonClient, LiveError> find(const LiveOptions& options);

  const status_t& status() const noexcept { return status_; }
  /// Returns the node-ID of a node that is given as number or name; 0 for "all".
  std::expected<std::int16_t, LiveError> node(const std::string& text) const;

  /// Sends a request and waits for its answer for at most `limit`, which must be longer than the
  /// daemon itself waits for the service.
  std::expected<reply_t, LiveError> ask(request_t request, Time limit);

  /// Sends a message on the channel BUS_WHAT, in an envelope if there is a key.
  void send(std::string_view what, Bytes message);
  /// Passes arriving messages to `handler`, for dialogues of more than one message. Returns after
  /// the first ones, at the latest at `until` (monotonic).
  void serve(const MessageHandler& handler, Time until);
  /// Returns true if the daemon has refused messages because they came without an envelope, and
  /// this program has no key.
  bool lacks_key() const noexcept { return lacks_key_; }
  /// Explains why there is no answer, and what to do about it.
  LiveError silence() const;

 private:
  void note_event(Bytes data);

  DaemonClient(LcmClient lcm, status_t status, std::optional<EnvelopeSeal> seal)
      : lcm_{std::move(lcm)}, status_{std::move(status)}, seal_{std::move(seal)} {}

  LcmClient lcm_;
  status_t status_;
  std::optional<EnvelopeSeal> seal_;  // empty without keys
  bool lacks_key_ = false;
};

/// Opens LCM with these options and subscribes to the channels that match `patterns`.
std::expected<LcmClient, LiveError> open_live(const LiveOptions& options,
                                              const std::vector<std::string>& patterns);

/// Returns the buses whose status has come: the one with this name (the name in capitals also
/// matches), or all if `bus_name` is empty.
std::vector<const BusView*> chosen(const BusViews& views, const std::string& bus_name);

/// Explains why chosen() found no bus: lists the other buses, or says where no daemon answers and
/// what to try.
LiveError no_bus(const BusViews& views, const LcmClient& lcm, const std::string& bus_name);

/// Returns an error if one of the buses has two daemons, std::nullopt otherwise.
std::optional<LiveError> two_daemons(const std::vector<const BusView*>& buses);

/// Passes messages to `views` until `enough` returns true, at the latest until `until` (monotonic).
void listen(LcmClient& lcm, BusViews& views, Time until, const std::function<bool()>& enough);

}  // namespace takt
