#pragma once
#include <cstdint>
#include <deque>
#include <expected>
#include <functional>
#include <list>
#include <optional>
#include <string>
#include <takt/reply_t.hpp>
#include <takt/request_t.hpp>
#include <unordered_map>

#include "eds_parser/table/bus_plan.hpp"
#include "master/core/request.hpp"

namespace takt {

struct RequestsOptions {
  std::int64_t session = 0;
  bool observe = false;
};

/// Turns request_t messages into Requests, and Replies into reply_t messages. Each request gets
/// exactly one answer and is executed once, however often it is sent. A request that is repeated
/// within some seconds of its answer gets that answer again. Within the same time, another request
/// with the same sender and id is refused. A refused request may be sent again at once. Front
/// thread.
class Requests {
 public:
  /// `submit` hands a request to the bus thread; it returns false if the bus thread has too many.
  Requests(const BusPlan& plan, RequestsOptions options,
           std::function<bool(const Request&)> submit);

  /// Returns why a message is refused before any of it is stored: a text in it is too long.
  static std::optional<std::string> oversize(const request_t& message);

  /// Returns true if the very same message came a moment ago by another way (udpm and the hub).
  /// Call this once per message, before anything else is done with it.
  bool is_echo(const request_t& message, Time now);
  /// Returns an answer that is available at once, or std::nullopt if the answer comes later.
  std::optional<reply_t> take(const request_t& message, Time now);
  /// Takes a request that the front thread itself serves. `begin` begins it, or returns why it
  /// can't begin. finish() with the message and the answer must follow.
  using Begin = std::function<std::optional<std::string>(const request_t& message)>;
  std::optional<reply_t> take(const request_t& message, Time now, const Begin& begin);
  void finish(const request_t& message, const reply_t& reply, Time now);
  /// Returns the refusal of a message that has another schema or is for another session.
  std::optional<reply_t> refuse_foreign(const request_t& message) const;
  /// Returns the answer for the requester, or std::nullopt if nobody made the request. `axes` has
  /// one line for each axis that the newest stop did not confirm.
  std::optional<reply_t> finish(const Reply& reply, Time now, const std::string& axes = {});

  /// Begins the answer to a message: it repeats the id and the sender.
  reply_t reply_to(const request_t& message) const;
  reply_t refusal(const request_t& message, const std::string& why) const;
  std::size_t pending() const noexcept { return pending_.size(); }

 private:
  /// A request that is complete or in progress.
  struct Known {
    request_t message;
    Time answered = never;
    reply_t reply{};  // valid once answered
  };
  struct Heard {
    request_t message;
    Time when{};
  };

  std::expected<Request, std::string> translate(const request_t& message) const;
  std::string pdo_obstacle(const request_t& message) const;
  std::string nmt_obstacle(const request_t& message) const;
  std::optional<std::string> foreign(const request_t& message) const;
  Known* find(const request_t& message);
  void forget(Time now);
  std::optional<reply_t> take_again(const Known& known, const request_t& message) const;

  const BusPlan& plan_;
  RequestsOptions options_;
  std::function<bool(const Request&)> submit_;
  std::uint64_t next_id_ = 1;
  struct Pending {
    std::list<Known>::iterator known;
    RequestKind kind = RequestKind::sdo_upload;
  };
  std::list<Known> known_;  // oldest first
  std::unordered_map<std::uint64_t, Pending> pending_;
  std::deque<Heard> heard_;
};

inline constexpr std::string_view observing_text =
    "taktd only observes (--observe) and sends nothing";

// These functions return why a request can't be executed, or an empty text.
std::string node_obstacle(const BusPlan& plan, std::int32_t node);
std::string object_obstacle(const BusPlan& plan, std::int32_t node, std::int32_t index,
                            std::int32_t sub);

/// Limits the time-out of a message, in ms, to one minute.
Time request_timeout(std::int32_t milliseconds) noexcept;

/// Returns why an LSS request failed, from the last of its results.
std::string lss_fault_text(const Reply& reply);

/// Returns why an SDO transfer or a command failed, in words; empty if it did not fail.
std::string fault_text(SdoFault fault, std::uint32_t abort_code, const SdoSilence& silence = {});

}  // namespace takt
