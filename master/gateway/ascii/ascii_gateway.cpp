#include "master/gateway/ascii/ascii_gateway.hpp"

#include <algorithm>
#include <chrono>
#include <fmt/format.h>
#include <ranges>
#include <utility>

#include "master/core/lss/lss_command.hpp"
#include "master/gateway/ascii/ascii_text.hpp"
#include "master/units/units.hpp"
#include "master/wire/sdo_abort.hpp"

namespace takt {
namespace {

using namespace ascii;

constexpr std::uint32_t only_net = 1;

Request lss_request(std::span<const LssCommand> commands, std::uint32_t timeout_ms) {
  Request request{.kind = RequestKind::lss, .timeout = std::chrono::milliseconds{timeout_ms}};
  for (const LssCommand& command : commands) {
    pack(command, std::span{request.data}.subspan(request.size).first<lss_command_bytes>());
    request.size = static_cast<std::uint16_t>(request.size + lss_command_bytes);
  }
  return request;
}

const PdoRow* find_row(const std::vector<PdoRow>& rows, std::uint32_t node, std::uint32_t number) {
  const auto found = std::ranges::find_if(rows, [&](const PdoRow& row) {
    return row.node.value() == node && row.number == number && !row.on_request;
  });
  return found == rows.end() ? nullptr : &*found;
}

}  // namespace

AsciiGateway::AsciiGateway(const BusPlan& plan, AsciiPorts ports)
    : plan_{plan}, ports_{std::move(ports)} {}

void AsciiGateway::disconnect(int client) {
  clients_.erase(client);
  for (auto& [id, pending] : pending_) {
    if (pending.client == client) pending.client = -1;
  }
}

void AsciiGateway::finish(int client, std::uint32_t sequence, const Answer& answer) {
  ports_.send(client, answer ? fmt::format("[{}] {}", sequence, *answer)
                             : error_line(sequence, answer.error(), text(answer.error())));
}

void AsciiGateway::refuse(int client, const AsciiRefusal& refusal) {
  std::string why{text(refusal.error)};
  if (!refusal.why.empty()) why += ": " + refusal.why;
  std::ranges::replace_if(why, [](unsigned char c) { return c < 0x20 || c == 0x7F; }, '?');
  ports_.send(client, error_line(refusal.sequence, refusal.error, why));
}

void AsciiGateway::command(int client, std::string_view line) {
  const auto found = clients_.find(client);
  if (found == clients_.end()) return;
  const auto command = parse_ascii(line);
  if (!command) return refuse(client, command.error());
  if (*command) run(client, found->second, **command);
}

void AsciiGateway::refuse_waited(int client, std::string_view line, Time gap) {
  const auto command = parse_ascii(line);
  if (!command) return refuse(client, command.error());
  if (!*command) return;
  refuse(client,
         {.sequence = (*command)->sequence,
          .error = AsciiError::internal_state,
          .why = fmt::format(
              "taktd did not run for {} ms, and this line may have waited as long: send it again",
              gap / std::chrono::milliseconds{1})});
}

void AsciiGateway::refuse_waited_outputs(int client, std::string_view line, Time gap) {
  const auto parsed = parse_ascii(line);
  const bool sets_outputs = parsed && *parsed && (*parsed)->verb == AsciiVerb::pdo_write;
  if (sets_outputs) return refuse_waited(client, line, gap);
  command(client, line);
}

void AsciiGateway::refuse_long_line(int client) {
  refuse(client, {.sequence = 0, .error = AsciiError::syntax, .why = "the line is too long"});
}

std::expected<std::uint32_t, AsciiError> AsciiGateway::address(const Client& state,
                                                               const AsciiCommand& command) {
  if (command.net && *command.net != only_net) return std::unexpected{AsciiError::unsupported_net};
  const std::uint32_t node = command.node.value_or(state.node);
  const bool all = command.verb == AsciiVerb::nmt && command.node == 0U;
  if (node == 0 && !command.node) return std::unexpected{AsciiError::no_default_node};
  if (node > 127 || (node == 0 && !all)) return std::unexpected{AsciiError::unsupported_node};
  return node;
}

void AsciiGateway::run(int client, Client& state, const AsciiCommand& command) {
  const auto done = [&](const Answer& answer) { finish(client, command.sequence, answer); };
  switch (command.verb) {
    case AsciiVerb::set_network:
      if (command.number == only_net) return done("OK");
      return done(std::unexpected{AsciiError::unsupported_net});
    case AsciiVerb::set_node:
      state.node = command.number;
      return done("OK");
    case AsciiVerb::set_sdo_timeout:
      state.sdo_timeout = std::chrono::milliseconds{command.number};
      return done("OK");
    case AsciiVerb::boot_up_indication:
      state.reports_bootups = command.number != 0;
      return done("OK");
    case AsciiVerb::info_version:  // vendor product revision serial class protocol implementation
      return done("0 0 0.0 0 3 3.0 0.1");
    case AsciiVerb::help:
      for (const auto line : std::views::split(ascii_help(), '\n')) {
        ports_.send(client, {line.begin(), line.end()});
      }
      return done("OK");
    case AsciiVerb::lss:
    case AsciiVerb::lss_all_nodes:
      return submit_lss(client, state, command);
    case AsciiVerb::pdo_read:
    case AsciiVerb::pdo_write:
    case AsciiVerb::sdo_read:
    case AsciiVerb::sdo_write:
    case AsciiVerb::nmt:
      break;
  }
  const auto node = address(state, command);
  if (!node) return done(std::unexpected{node.error()});
  if (command.verb == AsciiVerb::pdo_read) return done(read_pdo(*node, command));
  if (command.verb == AsciiVerb::pdo_write) return write_pdo(client, *node, command);
  Request request{.kind = command.verb == AsciiVerb::nmt         ? RequestKind::nmt
                          : command.verb == AsciiVerb::sdo_write ? RequestKind::sdo_download
                                                                 : RequestKind::sdo_upload,
                  .node = static_cast<std::uint8_t>(*node),
                  .object = command.object,
                  .command = command.nmt,
                  .timeout = state.sdo_timeout,
                  .size = static_cast<std::uint16_t>(command.value.size())};
  std::ranges::copy(command.value, request.data.begin());
  submit(client, state, command, request);
}

void AsciiGateway::submit(int client, Client& state, AsciiCommand command, Request request) {
  request.id = mark | next_id_;
  if (state.pending == most_pending || !ports_.submit(request)) {
    return finish(client, command.sequence, std::unexpected{AsciiError::internal_state});
  }
  ++state.pending;
  pending_.emplace(mark | next_id_++, Pending{client, std::move(command)});
}

void AsciiGateway::submit_lss(int client, Client& state, const AsciiCommand& command) {
  if (command.net && *command.net != only_net) {
    return finish(client, command.sequence, std::unexpected{AsciiError::unsupported_net});
  }
  std::vector<LssCommand> services{command.lss};
  if (command.lss_all_parts) {
    for (const LssOp op :
         {LssOp::inquire_product, LssOp::inquire_revision, LssOp::inquire_serial}) {
      services.push_back({.op = op});
    }
  }
  if (command.verb == AsciiVerb::lss_all_nodes) {
    services.push_back(
        {.op = LssOp::configure_node_id, .a = static_cast<std::uint8_t>(command.number)});
    if (command.store) services.push_back({.op = LssOp::store});
    services.push_back({.op = LssOp::switch_global});
  }
  submit(client, state, command, lss_request(services, command.lss_timeout_ms));
}

AsciiGateway::Answer AsciiGateway::read_pdo(std::uint32_t node, const AsciiCommand& command) const {
  const PdoRow* const row = find_row(plan_.pdos.tpdos, node, command.number);
  if (row == nullptr) return std::unexpected{AsciiError::unsupported_node};
  std::string text = fmt::format("{} pdo {}", only_net, row->field_count);
  for (const PdoField& field : plan_.pdos.fields_of(*row)) {
    const std::size_t signal = field.signal;
    const bool known = signal < values_.size() && (stale_[signal / 64] >> (signal % 64) & 1) == 0;
    if (!known) return std::unexpected{AsciiError::timeout};
    text += fmt::format(" {}", values_[signal]);
  }
  return text;
}

void AsciiGateway::write_pdo(int client, std::uint32_t node, const AsciiCommand& command) {
  const auto wrong = [&](AsciiError error) {
    finish(client, command.sequence, std::unexpected{error});
  };
  const PdoRow* const row = find_row(plan_.pdos.rpdos, node, command.number);
  if (row == nullptr) return wrong(AsciiError::unsupported_node);
  if (command.values.size() > row->field_count) return wrong(AsciiError::pdo_length);
  std::vector<SignalIndex> signals;
  for (std::size_t i = 0; i < command.values.size(); ++i) {
    signals.push_back(plan_.pdos.fields[row->first_field + i].signal);
    const Signal& signal = plan_.layout.signals[signals.back()];
    if (fits(signal.type, signal.bits, command.values[i])) continue;
    return refuse(client, {.sequence = command.sequence,
                           .error = AsciiError::syntax,
                           .why = fmt::format("{} does not fit the {} bits of {}",
                                              command.values[i], signal.bits, signal.name)});
  }
  if (!ports_.write(signals, command.values)) return wrong(AsciiError::internal_state);
  finish(client, command.sequence, "OK");
}

void AsciiGateway::take(const Reply& reply) {
  const auto found = pending_.find(reply.id);
  if (found == pending_.end()) return;
  Pending pending = std::move(found->second);
  pending_.erase(found);
  const auto client = clients_.find(pending.client);
  if (client == clients_.end()) return;
  --client->second.pending;
  const AsciiCommand& command = pending.command;
  if (command.verb == AsciiVerb::lss_all_nodes) return follow_all_nodes(std::move(pending), reply);
  const auto finished = [&](const Answer& answer) {
    finish(pending.client, command.sequence, answer);
  };
  if (reply.fault != SdoFault::none && reply.abort_code == 0) {
    return finished(std::unexpected{error_of(reply)});
  }
  if (reply.fault != SdoFault::none) {
    return ports_.send(pending.client, abort_line(command.sequence, reply.abort_code));
  }
  if (command.verb == AsciiVerb::lss) return finished(lss_answer(command, reply));
  if (command.verb != AsciiVerb::sdo_read) return finished("OK");
  const auto value = ascii_text(command.type, std::span{reply.data}.first(reply.size));
  if (value) return finished(*value);
  ports_.send(pending.client, abort_line(command.sequence, abort_code::length_mismatch));
}

/// Assigns node-IDs to one device after the other, until no device or no node-ID is left.
void AsciiGateway::follow_all_nodes(Pending pending, const Reply& reply) {
  const int client = pending.client;
  AsciiCommand& command = pending.command;
  const auto results = lss_results(reply);
  const bool nobody = !results.empty() && results.front().outcome == LssOutcome::nobody;
  if (reply.fault != SdoFault::none && !nobody) {
    return finish(client, command.sequence, std::unexpected{error_of(reply)});
  }
  if (!nobody && !results.empty()) {
    ports_.send(client, fmt::format("# node-ID {} assigned to: {}", command.number,
                                    address_text(results.front())));
    ++command.number;
  }
  if (nobody || command.number > 127) return finish(client, command.sequence, "OK");
  submit_lss(client, clients_.at(client), command);
}

void AsciiGateway::report_all(const std::string& line, bool bootup) {
  for (const auto& [client, state] : clients_) {
    if (!bootup || state.reports_bootups) ports_.send(client, line);
  }
}

void AsciiGateway::hear(const Event& event) {
  const auto from_node = [&](std::string_view text) {
    return fmt::format("{} {} {}", only_net, event.node, text);
  };
  if (event.node == 0) {
    const std::string text = bus_event(event.kind);
    if (!text.empty()) report_all(fmt::format("{} {}", only_net, text));
  } else if (is_bootup(event)) {
    report_all(from_node("BOOT_UP"), true);
  } else if (const std::string text = node_event(event); !text.empty()) {
    report_all(from_node(text));
  }
}

void AsciiGateway::see(const ImageView& image) {
  values_.assign(image.values.begin(), image.values.end());
  stale_.assign(image.stale_bits.begin(), image.stale_bits.end());
}

}  // namespace takt
