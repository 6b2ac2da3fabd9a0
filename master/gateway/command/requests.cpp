#include "master/gateway/command/requests.hpp"

#include <algorithm>
#include <chrono>
#include <fmt/format.h>
#include <iterator>
#include <tuple>
#include <utility>

#include "eds_parser/values/name_of.hpp"
#include "master/core/lss/lss_command.hpp"
#include "master/gateway/command/lease.hpp"
#include "master/gateway/notice/notice.hpp"
#include "master/lcm/messages.hpp"
#include "master/lcm/printable_text.hpp"
#include "master/wire/sdo_abort.hpp"

namespace takt {
namespace {

using namespace std::chrono_literals;

constexpr std::size_t most_known_requests = 256;
constexpr std::size_t most_heard = 64;
constexpr std::size_t most_pending = 64;
constexpr std::size_t longest_service = 32;
/// Time for which an answer is remembered. It is longer than the 11 s in which a copy of a request
/// can be accepted: from 1 s before its utime until 10 s after it.
constexpr Time remembered = 12s;

bool same_message(const request_t& a, const request_t& b) {
  const auto fields = [](const request_t& m) {
    return std::tie(m.utime, m.schema, m.session, m.id, m.sender, m.service, m.node_id, m.index,
                    m.sub, m.nmt_command, m.timeout_ms, m.data);
  };
  return fields(a) == fields(b);
}

bool is_nmt_command(std::int16_t code) noexcept {
  constexpr std::int16_t commands[] = {1, 2, 128, 129, 130};
  return std::ranges::find(commands, code) != std::end(commands);
}

struct Service {
  std::string_view name;
  RequestKind kind;
};
constexpr Service services[] = {{"sdo_upload", RequestKind::sdo_upload},
                                {"sdo_download", RequestKind::sdo_download},
                                {"pdo_poll", RequestKind::pdo_poll},
                                {"pdo_exchange", RequestKind::pdo_exchange},
                                {"lss", RequestKind::lss},
                                {"nmt", RequestKind::nmt}};

std::string silence_text(const SdoSilence& silence) {
  std::string text = "the device did not answer in time";
  if (silence.answered) {
    text += fmt::format("; it sent an answer for {} instead", to_string(*silence.answered));
  } else if (silence.late != Time{}) {
    text += fmt::format(
        "; it answered an earlier request after {} ms: raise `sdo_timeout_ms` of the node, or the "
        "time-out of this request",
        silence.late / std::chrono::milliseconds{1});
  }
  return text;
}

}  // namespace

std::string fault_text(SdoFault fault, std::uint32_t abort_code, const SdoSilence& silence) {
  static constexpr std::string_view texts[] = {
      // transfers
      "", "the device refused the access with SDO abort",
      "the device violated the SDO protocol; takt ended the transfer with",
      "the device did not answer in time",
      "the value is longer than 1024 bytes, the maximum of a request; read it as a file",
      "the node was reset, or the master stops",
      // requests
      "the network file has no such node", "the master only observes and sends nothing",
      "the network file has no such PDO of this node, or it can't be requested: `takt plan` lists "
      "the PDOs",
      "the node is not operational: PDOs are exchanged in OPERATIONAL only",
      "an LSS service failed",
      "the daemon accepts 1 to 28 LSS services in a request, and does not activate another bit "
      "rate while it runs: stop the daemon and use takt lss with --bus",
      "the RPDO has another number of bytes: `takt plan` shows its mapping",
      "the command was executed, but not every axis was seen at standstill and disabled before the "
      "command"};
  static_assert(request_bytes == 1024);
  const std::string_view text = name_of(fault, texts);
  if (fault == SdoFault::timeout) return silence_text(silence);
  const bool aborted = fault == SdoFault::aborted_by_device || fault == SdoFault::aborted_by_master;
  if (!aborted) return std::string{text};
  return fmt::format("{} {} ({})", text, hex(abort_code, 8), abort_text(abort_code));
}

std::string lss_fault_text(const Reply& reply) {
  if (reply.size < lss_result_bytes || reply.size > reply.data.size()) {
    return fault_text(reply.fault, reply.abort_code, reply.silence);
  }
  return lss_failure_text(unpack_lss_result(
      std::span{reply.data}.subspan(reply.size - lss_result_bytes).first<lss_result_bytes>()));
}

Requests::Requests(const BusPlan& plan, RequestsOptions options,
                   std::function<bool(const Request&)> submit)
    : plan_{plan}, options_{options}, submit_{std::move(submit)} {}

reply_t Requests::reply_to(const request_t& message) const {
  reply_t reply{};
  reply.schema = message_schema;
  reply.session = options_.session;
  reply.id = message.id;
  reply.sender = message.sender.substr(0, longest_sender);
  return reply;
}

reply_t Requests::refusal(const request_t& message, const std::string& why) const {
  reply_t reply = reply_to(message);
  reply.text = printable_text(why);
  return reply;
}

std::optional<std::string> Requests::oversize(const request_t& message) {
  if (message.sender.size() > longest_sender) {
    return fmt::format("the sender's name is longer than {} bytes", longest_sender);
  }
  if (message.service.size() > longest_service) {
    return fmt::format(
        "service '{:.32}...' is not known: the name of a service has at most {} bytes",
        message.service, longest_service);
  }
  if (message.data.size() > request_bytes) {
    return fmt::format("a request carries at most {} bytes", request_bytes);
  }
  return std::nullopt;
}

bool Requests::is_echo(const request_t& message, Time now) {
  while (!heard_.empty() && now - heard_.front().when > echo_limit) heard_.pop_front();
  const auto same = [&](const Heard& heard) { return same_message(heard.message, message); };
  if (oversize(message)) return false;  // the caller will refuse it
  if (std::ranges::any_of(heard_, same)) return true;
  if (heard_.size() == most_heard) heard_.pop_front();
  heard_.push_back({message, now});
  return false;
}

void Requests::forget(Time now) {
  std::erase_if(known_, [now](const Known& known) {
    return known.answered != never && now - known.answered > remembered;
  });
  if (known_.size() < most_known_requests) return;
  const auto answered =
      std::ranges::find_if(known_, [](const Known& known) { return known.answered != never; });
  if (answered != known_.end()) known_.erase(answered);
}

/// Answers a request that has come before. A request in progress gets no answer now, because its
/// answer will follow.
std::optional<reply_t> Requests::take_again(const Known& known, const request_t& message) const {
  if (known.answered == never) return std::nullopt;
  if (same_message(known.message, message)) return known.reply;
  return refusal(
      message,
      fmt::format(
          "id {} of this sender was used some seconds ago already; each request needs a new id",
          message.id));
}

std::optional<reply_t> Requests::take(const request_t& message, Time now) {
  forget(now);
  if (auto why = oversize(message)) return refusal(message, *why);
  if (const Known* const known = find(message)) return take_again(*known, message);
  auto request = translate(message);
  if (!request) return refusal(message, request.error());
  request->id = next_id_;
  if (pending_.size() == most_pending || !submit_(*request)) {
    return refusal(message, "too many requests came at once; send the request again later");
  }
  known_.push_back({.message = message});
  pending_.emplace(next_id_++, Pending{std::prev(known_.end()), request->kind});
  return std::nullopt;
}

std::optional<reply_t> Requests::take(const request_t& message, Time now, const Begin& begin) {
  forget(now);
  if (auto why = oversize(message)) return refusal(message, *why);
  if (const Known* const known = find(message)) return take_again(*known, message);
  if (auto refused = refuse_foreign(message)) return refused;
  const auto added = known_.insert(known_.end(), {.message = message});
  const auto why = begin(message);
  if (!why) return std::nullopt;
  known_.erase(added);
  return refusal(message, *why);
}

void Requests::finish(const request_t& message, const reply_t& reply, Time now) {
  Known* const known = find(message);
  if (known == nullptr) return;
  known->answered = now;
  known->reply = reply;
}

Requests::Known* Requests::find(const request_t& message) {
  const auto found = std::ranges::find_if(known_, [&](const Known& known) {
    return known.message.id == message.id && known.message.sender == message.sender;
  });
  return found == known_.end() ? nullptr : &*found;
}

std::optional<std::string> Requests::foreign(const request_t& message) const {
  if (message.schema != message_schema) return schema_refusal(message.schema);
  if (message.session == 0 || message.session == options_.session) return std::nullopt;
  return "the request is for another session of taktd";
}

std::optional<reply_t> Requests::refuse_foreign(const request_t& message) const {
  if (const auto why = foreign(message)) return refusal(message, *why);
  return std::nullopt;
}

std::expected<Request, std::string> Requests::translate(const request_t& message) const {
  if (const auto why = foreign(message)) return std::unexpected{*why};
  if (options_.observe) return std::unexpected{std::string{observing_text}};
  if (message.node_id < 0 || message.node_id > 127) {
    return std::unexpected{fmt::format("node {} is not in 1..127", message.node_id)};
  }
  const auto service = std::ranges::find(services, message.service, &Service::name);
  if (service == std::end(services)) {
    return std::unexpected{
        fmt::format("service '{}' is not known; the services are sdo_upload, sdo_download, "
                    "pdo_poll, pdo_exchange, lss and nmt",
                    message.service)};
  }
  Request request{.kind = service->kind,
                  .node = static_cast<std::uint8_t>(message.node_id),
                  .timeout = request_timeout(message.timeout_ms),
                  .size = static_cast<std::uint16_t>(message.data.size())};
  std::ranges::copy(std::as_bytes(std::span{message.data}), request.data.begin());
  std::string obstacle;
  switch (service->kind) {
    case RequestKind::sdo_upload:
    case RequestKind::sdo_download:
      obstacle = object_obstacle(plan_, message.node_id, message.index, message.sub);
      request.object = {static_cast<std::uint16_t>(message.index),
                        static_cast<std::uint8_t>(message.sub)};
      break;
    case RequestKind::pdo_poll:
    case RequestKind::pdo_exchange:
      obstacle = pdo_obstacle(message);
      request.object = {static_cast<std::uint16_t>(message.index), 0};
      break;
    case RequestKind::nmt:
      obstacle = nmt_obstacle(message);
      request.command = static_cast<NmtCommand>(message.nmt_command);
      break;
    case RequestKind::lss:
      break;
  }
  if (!obstacle.empty()) return std::unexpected{std::move(obstacle)};
  return request;
}

std::string node_obstacle(const BusPlan& plan, std::int32_t node) {
  if (plan.find(static_cast<unsigned>(node)) != nullptr) return {};
  return fmt::format("node {} is not in the network file of bus '{}'", node, plan.name);
}

std::string object_obstacle(const BusPlan& plan, std::int32_t node, std::int32_t index,
                            std::int32_t sub) {
  std::string obstacle = node_obstacle(plan, node);
  if (!obstacle.empty()) return obstacle;
  const bool fits = index >= 0 && index <= 0xFFFF && sub >= 0 && sub <= 0xFF;
  return fits ? "" : "index or sub-index is out of range";
}

std::string Requests::pdo_obstacle(const request_t& message) const {
  std::string obstacle = node_obstacle(plan_, message.node_id);
  if (!obstacle.empty()) return obstacle;
  if (message.index < 1 || message.index > 512) {
    return fmt::format("PDO number {} is not in 1..512", message.index);
  }
  return message.data.size() > 8 ? "a PDO has at most 8 bytes" : "";
}

std::string Requests::nmt_obstacle(const request_t& message) const {
  if (!is_nmt_command(message.nmt_command)) {
    return fmt::format("NMT command {} is not one of 1, 2, 128, 129, 130", message.nmt_command);
  }
  const unsigned master = plan_.master_id.value();
  const bool known = message.node_id == 0 || static_cast<unsigned>(message.node_id) == master;
  const std::string obstacle = known ? "" : node_obstacle(plan_, message.node_id);
  if (obstacle.empty()) return {};
  return fmt::format("{}; the master is node {}", obstacle, master);
}

Time request_timeout(std::int32_t milliseconds) noexcept {
  return std::chrono::milliseconds{std::clamp(milliseconds, 0, 60'000)};
}

std::optional<reply_t> Requests::finish(const Reply& reply, Time now, const std::string& axes) {
  const auto found = pending_.find(reply.id);
  if (found == pending_.end()) return std::nullopt;
  Known& known = *found->second.known;
  reply_t message = reply_to(known.message);
  message.good = reply.fault == SdoFault::none ? 1 : 0;
  message.abort_code = reply.abort_code;
  message.text = reply.fault == SdoFault::lss_failed
                     ? lss_fault_text(reply)
                     : fault_text(reply.fault, reply.abort_code, reply.silence);
  if (reply.fault == SdoFault::axes_not_stopped && !axes.empty()) message.text += ":\n" + axes;
  const RequestKind kind = found->second.kind;
  if (kind != RequestKind::sdo_download && kind != RequestKind::nmt) {
    message.size = reply.size;
    const auto bytes = octets(reply.data).first(reply.size);
    message.data.assign(bytes.begin(), bytes.end());
  }
  pending_.erase(found);
  known.answered = now;
  known.reply = message;
  return message;
}

}  // namespace takt
