#pragma once
#include <functional>
#include <optional>
#include <string>
#include <takt/reply_t.hpp>
#include <takt/request_t.hpp>
#include <takt/status_t.hpp>
#include <utility>
#include <vector>

#include "apps/command_line/failure.hpp"
#include "apps/command_line/live_arguments.hpp"
#include "master/gateway/message/bus_view.hpp"
#include "master/lcm/envelope/envelope.hpp"
#include "master/lcm/link/lcm_client.hpp"

namespace takt {

/// The daemon of one bus. All functions throw a Failure if the daemon does not answer.
class DaemonClient {
 public:
  /// Finds the daemon of the bus that `options` name, or of the only bus. Throws a Failure if
  /// several buses run and `options` name none of them.
  static DaemonClient find(const LiveOptions& options);

  const status_t& status() const noexcept { return status_; }
  /// Returns the node-ID of a node that is given as number or name; 0 for "all". Throws a Failure
  /// that lists the nodes if the bus has no such node.
  std::int16_t node(const std::string& text) const;
  /// Returns std::nullopt if the bus has no such node.
  std::optional<std::int16_t> find_node(const std::string& text) const;

  /// Sends a request and waits for its answer for at most `limit`, which must be longer than the
  /// daemon itself waits for the service. The answer may be a refusal.
  reply_t ask(request_t request, Time limit);
  /// Sends a request as ask() does. Throws a Failure with the reason if the answer is a refusal.
  reply_t demand(request_t request, Time limit);

  /// Sends a message on the channel BUS_WHAT, in an envelope if there is a key.
  void send(std::string_view what, Bytes message);
  /// Passes arriving messages to `handler`, for dialogues of more than one message. Returns after
  /// the first messages that have arrived, at the latest at `until` (monotonic).
  void serve(const MessageHandler& handler, Time until);
  /// Returns true if the daemon has refused messages because they came without an envelope, and
  /// this program has no key.
  bool lacks_key() const noexcept { return lacks_key_; }
  /// Explains why there is no answer, and what to do about it.
  Failure silence() const;

 private:
  void note_event(Bytes data);

  DaemonClient(LcmClient lcm, status_t status, std::optional<EnvelopeSeal> seal)
      : lcm_{std::move(lcm)}, status_{std::move(status)}, seal_{std::move(seal)} {}

  LcmClient lcm_;
  status_t status_;
  std::optional<EnvelopeSeal> seal_;  // empty without keys
  bool lacks_key_ = false;
};

/// Returns a request without its identification, which DaemonClient::ask() adds.
request_t make_request(const char* service, std::int16_t node = 0);
/// Puts bytes into the fields `data` and `size` of a request_t or transfer_t.
template <class Message>
void set_data(Message& message, Bytes bytes) {
  const auto* const first = reinterpret_cast<const std::uint8_t*>(bytes.data());
  message.data.assign(first, first + bytes.size());
  message.size = static_cast<std::int32_t>(bytes.size());
}
/// Returns the name of this program as the sender of messages. It is unique on this machine.
std::string own_sender();
/// Returns the time of day for the field `utime` of a message.
std::int64_t utime_now();

/// Opens LCM with these options and subscribes to the channels BUS_WHAT of all buses.
LcmClient open_live(const LiveOptions& options, const std::vector<std::string_view>& whats);

/// Returns the buses whose status has come: the one with this name (the name in capitals also
/// matches), or all if `bus_name` is empty.
std::vector<const BusView*> chosen(const BusViews& views, const std::string& bus_name);

/// Waits for the status of a bus, and then until every bus has sent one. Returns the buses as
/// chosen() does. Throws no_bus() if there is none.
std::vector<const BusView*> find_buses(LcmClient& lcm, BusViews& views,
                                       const std::string& bus_name);

/// Explains why chosen() found no bus: lists the other buses, or says where no daemon answers and
/// what to try.
Failure no_bus(const BusViews& views, const LcmClient& lcm, const std::string& bus_name);

/// Throws a Failure if one of the buses has two daemons.
void refuse_two_daemons(const std::vector<const BusView*>& buses);

/// Passes messages to `views` until `enough` returns true, at the latest until `until` (monotonic).
void listen(LcmClient& lcm, BusViews& views, Time until, const std::function<bool()>& enough);

}  // namespace takt
