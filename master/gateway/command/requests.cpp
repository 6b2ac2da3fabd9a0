#include "master/gateway/command/requests.hpp"

#include <algorithm>
#include <chrono>
#include <iterator>
#include <tuple>
#include <utility>

#include "master/core/lss/lss_command.hpp"
#include "master/gateway/notice/notice.hpp"
#include "master/lcm/messages.hpp"
#include "master/lcm/printable_text.hpp"
#include "master/wire/sdo_abort.hpp"

namespace takt {
namespace {

using namespace std::chrono_literals;

constexpr std::size_t most_known = 256;
constexpr std::size_t most_heard = 64;
constexpr std::size_t most_pending = 64;
constexpr std::size_t longest_sender = 64;
constexpr std::size_t longest_service = 32;
/// Time after the answer. It is longer than the 11 s for which a copy of a request can be accepted:
/// from 1 s before its utime until 10 s after it.
constexpr Time remembered = 12s;
constexpr Time echo_limit = 50ms;  // time between the arrivals of one message by two ways

bool same_asker(const request_t& a, const request_t& b) {
  return a.id == b.id && a.sender == b.sender;
}

bool same_message(const request_t& a, const request_t& b) {
  const auto fields = [](const request_t& m) {
    return std::tie(m.utime, m.schema, m.session, m.id, m.sender, m.service, m.node_id, m.index,
                    m.sub, m.nmt_command, m.timeout_ms, m.data);
  };
  return fields(a) == fields(b);
}

std::optional<NmtCommand> nmt_command(std::int16_t code) noexcept {
  switch (static_cast<NmtCommand>(code)) {
    case NmtCommand::start:
    case NmtCommand::stop:
    case NmtCommand::enter_preoperational:
    case NmtCommand::reset_node:
    case NmtCommand::reset_communication:
      return static_cast<NmtCommand>(code);
  }
  return std::nullopt;
}

std::string silence_text(const SdoSilence& silence) {
  std::string text = "the device did not answer in time";
  if (silence.answered) {
    text += "; it sent an answer for " + to_string(*silence.answered) + " instead";
  } else if (silence.late != Time{}) {
    text += "; it answered an earlier request after " +
            std::to_string(silence.late / std::chrono::milliseconds{1}) +
            " ms: raise `sdo_timeout_ms` of the node, or the time-out of this request";
  }
  return text;
}

}  // namespace

std::string fault_text(SdoFault fault, std::uint32_t abort_code, const SdoSilence& silence) {
  const auto abort = [&] {
    return hex(abort_code, 8) + " (" + std::string{abort_text(abort_code)} + ")";
  };
  switch (fault) {
    case SdoFault::none:
      return {};
    case SdoFault::aborted_by_device:
      return "the device refused the access with SDO abort " + abort();
    case SdoFault::aborted_by_master:
      return "the device violated the SDO protocol; takt ended the transfer with " + abort();
    case SdoFault::timeout:
      return silence_text(silence);
    case SdoFault::too_long:
      return "the value is longer than " + std::to_string(request_bytes) +
             " bytes, the maximum of a request; read it as a file";
    case SdoFault::no_such_node:
      return "the network file has no such node";
    case SdoFault::refused:
      return "the master only observes and sends nothing";
    case SdoFault::cancelled:
      return "the node was reset, or the master stops";
    case SdoFault::axes_not_stopped:
      return "the command was executed, but not every axis was seen at standstill and disabled "
             "before";
    case SdoFault::no_such_pdo:
      return "the network file has no such PDO of this node, or it can't be requested: `takt plan` "
             "lists the PDOs";
    case SdoFault::not_exchanging:
      return "the node is not operational: PDOs are exchanged in OPERATIONAL only";
    case SdoFault::lss_failed:
      return "an LSS service failed";
    case SdoFault::lss_refused:
      return "the daemon accepts 1 to 28 LSS services in a request, and does not activate another "
             "bit rate while it runs: stop the daemon and use takt lss with --bus";
    case SdoFault::wrong_length:
      return "the RPDO has another number of bytes: `takt plan` shows its mapping";
  }
  return {};
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
    return "the sender's name is longer than " + std::to_string(longest_sender) + " bytes";
  }
  if (message.service.size() > longest_service) {
    return "service '" + message.service.substr(0, longest_service) +
           "...' is not known: the name of a service has at most 32 bytes";
  }
  if (message.data.size() > request_bytes) {
    return "a request carries at most " + std::to_string(request_bytes) + " bytes";
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
  if (known_.size() < most_known) return;
  const auto answered =
      std::ranges::find_if(known_, [](const Known& known) { return known.answered != never; });
  if (answered != known_.end()) known_.erase(answered);
}

/// Answers a known request again. A request in progress gets no second answer.
std::optional<reply_t> Requests::take_again(const Known& known, const request_t& message) const {
  if (known.answered == never) return std::nullopt;
  if (same_message(known.message, message)) return known.reply;
  return refusal(message, "id " + std::to_string(message.id) + " of this sender was used " +
                              "some seconds ago already; each request needs a new id");
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
  const auto found = std::ranges::find_if(
      known_, [&](const Known& known) { return same_asker(known.message, message); });
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
  if (options_.observe) {
    return std::unexpected{std::string{"taktd only observes (--observe) and sends nothing"}};
  }
  if (message.node_id < 0 || message.node_id > 127) {
    return std::unexpected{"node " + std::to_string(message.node_id) + " is not in 1..127"};
  }
  if (message.service == "nmt") return translate_nmt(message);
  if (message.service == "sdo_upload" || message.service == "sdo_download") {
    return translate_sdo(message);
  }
  if (message.service == "pdo_poll" || message.service == "pdo_exchange") {
    return translate_pdo(message);
  }
  if (message.service == "lss") return translate_lss(message);
  return std::unexpected{"service '" + message.service.substr(0, 32) +
                         "' is not known; the services are sdo_upload, sdo_download, pdo_poll, "
                         "pdo_exchange, lss and nmt"};
}

std::expected<Request, std::string> Requests::translate_lss(const request_t& message) {
  if (message.data.size() > request_bytes) {
    return std::unexpected{fault_text(SdoFault::lss_refused, 0)};
  }
  Request request;
  request.kind = RequestKind::lss;
  request.timeout = std::chrono::milliseconds{std::clamp(message.timeout_ms, 0, 60'000)};
  request.size = static_cast<std::uint16_t>(message.data.size());
  std::ranges::transform(message.data, request.data.begin(),
                         [](std::uint8_t byte) { return std::byte{byte}; });
  return request;
}

/// `index` of the message is the number of the PDO.
std::expected<Request, std::string> Requests::translate_pdo(const request_t& message) const {
  const auto node = static_cast<std::uint8_t>(message.node_id);
  if (node_name(plan_, node).empty()) {
    return std::unexpected{"node " + std::to_string(message.node_id) +
                           " is not in the network file of bus '" + plan_.name + "'"};
  }
  if (message.index < 1 || message.index > 512) {
    return std::unexpected{"PDO number " + std::to_string(message.index) + " is not in 1..512"};
  }
  if (message.data.size() > 8) return std::unexpected{std::string{"a PDO has at most 8 bytes"}};
  Request request;
  request.kind = message.service == "pdo_poll" ? RequestKind::pdo_poll : RequestKind::pdo_exchange;
  request.node = node;
  request.object = {static_cast<std::uint16_t>(message.index), 0};
  request.timeout = std::chrono::milliseconds{std::clamp(message.timeout_ms, 0, 60'000)};
  request.size = static_cast<std::uint16_t>(message.data.size());
  std::ranges::transform(message.data, request.data.begin(),
                         [](std::uint8_t byte) { return std::byte{byte}; });
  return request;
}

std::expected<Request, std::string> Requests::translate_nmt(const request_t& message) const {
  const auto command = nmt_command(message.nmt_command);
  if (!command) {
    return std::unexpected{"NMT command " + std::to_string(message.nmt_command) +
                           " is not one of 1, 2, 128, 129, 130"};
  }
  const bool of_all = message.node_id == 0;
  const bool of_master = message.node_id == plan_.master_id.value();
  if (!of_all && !of_master && plan_.find(static_cast<unsigned>(message.node_id)) == nullptr) {
    return std::unexpected{"node " + std::to_string(message.node_id) +
                           " is not in the network file of bus '" + plan_.name +
                           "'; the master is node " + std::to_string(plan_.master_id.value())};
  }
  Request request;
  request.kind = RequestKind::nmt;
  request.node = static_cast<std::uint8_t>(message.node_id);
  request.command = *command;
  return request;
}

std::expected<Request, std::string> Requests::translate_sdo(const request_t& message) const {
  const auto node = static_cast<std::uint8_t>(message.node_id);
  if (node_name(plan_, node).empty()) {
    return std::unexpected{"node " + std::to_string(message.node_id) +
                           " is not in the network file of bus '" + plan_.name + "'"};
  }
  if (message.index < 0 || message.index > 0xFFFF || message.sub < 0 || message.sub > 0xFF) {
    return std::unexpected{std::string{"index or sub-index is out of range"}};
  }
  if (message.data.size() > request_bytes) {
    return std::unexpected{"a request carries at most " + std::to_string(request_bytes) + " bytes"};
  }
  Request request;
  const bool upload = message.service == "sdo_upload";
  request.kind = upload ? RequestKind::sdo_upload : RequestKind::sdo_download;
  request.node = node;
  request.object = {static_cast<std::uint16_t>(message.index),
                    static_cast<std::uint8_t>(message.sub)};
  request.timeout = std::chrono::milliseconds{std::clamp(message.timeout_ms, 0, 60'000)};
  request.size = static_cast<std::uint16_t>(message.data.size());
  std::ranges::transform(message.data, request.data.begin(),
                         [](std::uint8_t byte) { return std::byte{byte}; });
  return request;
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
    message.data.resize(reply.size);
    std::transform(reply.data.begin(), reply.data.begin() + reply.size, message.data.begin(),
                   [](std::byte byte) { return std::to_integer<std::uint8_t>(byte); });
  }
  pending_.erase(found);
  known.answered = now;
  known.reply = message;
  return message;
}

}  // namespace takt
