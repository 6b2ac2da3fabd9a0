#include "master/gateway/ascii/ascii_command.hpp"

#include <span>

#include "master/core/request.hpp"
#include "master/gateway/ascii/ascii_words.hpp"

namespace takt {
namespace {

using namespace ascii;

Read<void> read_object(Words words, AsciiCommand& out) {
  const auto index = number(words, 1, 0xFFFF, "index");
  if (!index) return std::unexpected{index.error()};
  const auto sub = number(words, 2, 0xFF, "sub-index");
  if (!sub) return std::unexpected{sub.error()};
  out.object = {static_cast<std::uint16_t>(*index), static_cast<std::uint8_t>(*sub)};
  return {};
}

Read<void> read_type(Words words, AsciiCommand& out) {
  const auto type = parse_ascii_type(words[3].text);
  if (!type) return unsupported("data type '" + words[3].text + "' is not known");
  out.type = *type;
  return {};
}

Read<void> read_pdo(Words words, AsciiCommand& out) {
  const auto pdo = number(words, 2, 512, "PDO number");
  if (!pdo) return std::unexpected{pdo.error()};
  out.number = *pdo;
  if (out.verb == AsciiVerb::pdo_read) return end_at(words, 3);
  const auto count = number(words, 3, 64, "number of values");
  if (!count) return std::unexpected{count.error()};
  for (std::size_t i = 0; i < *count; ++i) {
    const auto value = 4 + i < words.size() ? parse_ascii_integer(words[4 + i].text) : std::nullopt;
    if (!value) return wrong("expected value " + std::to_string(i + 1));
    out.values.push_back(*value);
  }
  return end_at(words, 4 + *count);
}

bool is_pdo(Words words) { return words.size() > 1 && is(words[1], "p", "pdo"); }

Read<void> read_read(Words words, AsciiCommand& out) {
  out.verb = is_pdo(words) ? AsciiVerb::pdo_read : AsciiVerb::sdo_read;
  if (out.verb == AsciiVerb::pdo_read) return read_pdo(words, out);
  if (auto good = read_object(words, out); !good) return good;
  if (words.size() < 4) return {};
  if (auto good = read_type(words, out); !good) return good;
  return end_at(words, 4);
}

Read<void> read_write(Words words, AsciiCommand& out) {
  out.verb = is_pdo(words) ? AsciiVerb::pdo_write : AsciiVerb::sdo_write;
  if (out.verb == AsciiVerb::pdo_write) return read_pdo(words, out);
  if (auto good = read_object(words, out); !good) return good;
  if (words.size() < 5) return wrong("expected data type and value");
  if (auto good = read_type(words, out); !good) return good;
  std::string value = words[4].text;
  const bool joins = out.type.form == AsciiType::Form::hex && is_bytes(out.type.type);
  for (std::size_t i = 5; joins && i < words.size(); ++i) value += words[i].text;
  auto bytes = ascii_bytes(out.type, value);
  if (!bytes) return wrong(bytes.error());
  if (bytes->size() > request_bytes) {
    return unsupported("a value has at most " + std::to_string(request_bytes) + " bytes here");
  }
  out.value = std::move(*bytes);
  return joins ? Read<void>{} : end_at(words, 5);
}

Read<void> read_reset(Words words, AsciiCommand& out) {
  if (words.size() > 1 && is(words[1], "node")) {
    out.nmt = NmtCommand::reset_node;
  } else if (words.size() > 1 && is(words[1], "comm", "communication")) {
    out.nmt = NmtCommand::reset_communication;
  } else {
    return wrong("expected 'node' or 'comm'");
  }
  return end_at(words, 2);
}

/// Reads the settings of a client. Settings of the network file do not change while taktd runs.
Read<void> read_set(Words words, AsciiCommand& out) {
  struct Setting {
    std::string_view name;
    AsciiVerb verb;
    std::uint32_t most;
  };
  constexpr Setting settings[] = {{"network", AsciiVerb::set_network, 0xFFFF},
                                  {"node", AsciiVerb::set_node, 127},
                                  {"sdo_timeout", AsciiVerb::set_sdo_timeout, 60'000}};
  if (words.size() < 2) return wrong("expected what to set");
  for (const Setting& setting : settings) {
    if (!is(words[1], setting.name)) continue;
    out.verb = setting.verb;
    const auto value = number(words, 2, setting.most, "value");
    if (!value) return std::unexpected{value.error()};
    out.number = *value;
    return end_at(words, 3);
  }
  return unsupported("'set " + words[1].text +
                     "' is not for a running taktd: the network file says it");
}

Read<void> read_indication(Words words, AsciiCommand& out) {
  out.verb = AsciiVerb::boot_up_indication;
  const bool enables = words.size() > 1 && is(words[1], "enable");
  if (!enables && (words.size() < 2 || !is(words[1], "disable"))) {
    return wrong("expected Enable or Disable");
  }
  out.number = enables ? 1 : 0;
  return end_at(words, 2);
}

Read<void> read_command(Words words, AsciiCommand& out) {
  const Word& name = words[0];
  const auto nmt = [&](NmtCommand command) {
    out.verb = AsciiVerb::nmt;
    out.nmt = command;
    return end_at(words, 1);
  };
  if (is(name, "r", "read")) return read_read(words, out);
  if (is(name, "w", "write")) return read_write(words, out);
  if (is(name, "start")) return nmt(NmtCommand::start);
  if (is(name, "stop")) return nmt(NmtCommand::stop);
  if (is(name, "preop", "preoperational")) return nmt(NmtCommand::enter_preoperational);
  if (is(name, "reset")) {
    out.verb = AsciiVerb::nmt;
    return read_reset(words, out);
  }
  if (is(name, "set")) return read_set(words, out);
  if (is(name, "boot_up_indication")) return read_indication(words, out);
  if (is(name, "info")) {
    out.verb = AsciiVerb::info_version;
    if (words.size() < 2 || !is(words[1], "version")) return wrong("expected 'version'");
    return end_at(words, 2);
  }
  if (is(name, "help")) {
    out.verb = AsciiVerb::help;
    return {};
  }
  if (name.text.starts_with("lss_") || name.text.starts_with("_lss_")) return read_lss(words, out);
  if (is(name, "enable") || is(name, "disable") || is(name, "init")) {
    return unsupported("'" + name.text + "' is not for a running taktd: the network file says it");
  }
  return wrong("no command '" + name.text + "'; there is 'help'");
}

/// Reads `[seq]`, also with blanks inside, and returns the rest of the line.
Read<std::string_view> read_sequence(std::string_view line, std::uint32_t& sequence) {
  const std::size_t close = line.find(']');
  if (!line.starts_with('[') || close == line.npos) {
    return wrong("a command begins with its number: [1]");
  }
  std::string_view inside = line.substr(1, close - 1);
  while (inside.starts_with(' ')) inside.remove_prefix(1);
  while (inside.ends_with(' ')) inside.remove_suffix(1);
  const auto value = parse_ascii_integer(inside);
  if (!value || *value < 0 || *value > 0xFFFF'FFFF) {
    return wrong("the number of a command is 0..4294967295");
  }
  sequence = static_cast<std::uint32_t>(*value);
  return line.substr(close + 1);
}

bool about_network(const AsciiCommand& command) noexcept {
  switch (command.verb) {
    case AsciiVerb::sdo_read:
    case AsciiVerb::sdo_write:
    case AsciiVerb::pdo_read:
    case AsciiVerb::pdo_write:
    case AsciiVerb::nmt:
      return false;
    default:
      return true;
  }
}

/// Reads the numbers before the command: `node` or `net node`, or `net` for a command that concerns
/// the network.
Read<std::size_t> read_address(Words words, std::vector<std::uint32_t>& numbers) {
  std::size_t at = 0;
  while (at < words.size() && at < 2) {
    const auto value = parse_ascii_integer(words[at].text);
    if (!value || words[at].quoted) break;
    if (*value < 0 || *value > 0xFFFF) return wrong("net and node are numbers up to 65535");
    numbers.push_back(static_cast<std::uint32_t>(*value));
    ++at;
  }
  if (at == words.size()) return wrong("expected a command");
  return at;
}

Read<void> read_line(Words words, AsciiCommand& out) {
  std::vector<std::uint32_t> address;
  const auto begin = read_address(words, address);
  if (!begin) return std::unexpected{begin.error()};
  if (auto good = read_command(words.subspan(*begin), out); !good) return good;
  if (about_network(out)) {
    if (address.size() > 1) return wrong("this command takes a net and no node");
    if (!address.empty()) out.net = address[0];
    return {};
  }
  if (!address.empty()) out.node = address.back();
  if (address.size() > 1) out.net = address[0];
  return {};
}

}  // namespace

std::string_view text(AsciiError error) noexcept {
  switch (error) {
    case AsciiError::not_supported:
      return "request not supported";
    case AsciiError::syntax:
      return "syntax error";
    case AsciiError::internal_state:
      return "request not processed due to internal state";
    case AsciiError::timeout:
      return "time-out";
    case AsciiError::no_default_net:
      return "no default net set";
    case AsciiError::no_default_node:
      return "no default node set";
    case AsciiError::unsupported_net:
      return "unsupported net";
    case AsciiError::unsupported_node:
      return "unsupported node";
    case AsciiError::guarding_lost:
      return "lost guarding message";
    case AsciiError::heartbeat_started:
      return "heartbeat started";
    case AsciiError::heartbeat_lost:
      return "heartbeat lost";
    case AsciiError::error_passive:
      return "error passive";
    case AsciiError::bus_off:
      return "bus off";
    case AsciiError::buffer_overflow:
      return "CAN buffer overflow";
    case AsciiError::pdo_length:
      return "PDO length exceeded";
    case AsciiError::lss_manufacturer:
      return "LSS manufacturer-specific error";
    case AsciiError::lss_node_id:
      return "LSS node-ID not supported";
    case AsciiError::lss_bit_rate:
      return "LSS bit-rate not supported";
    case AsciiError::lss_store:
      return "LSS parameter storing failed";
    case AsciiError::lss_media:
      return "LSS command failed because of media error";
  }
  return "unknown error";
}

std::expected<std::optional<AsciiCommand>, AsciiRefusal> parse_ascii(std::string_view line) {
  while (!line.empty() && (blank(line.front()) || line.front() == '\r')) line.remove_prefix(1);
  while (!line.empty() && (blank(line.back()) || line.back() == '\r')) line.remove_suffix(1);
  if (line.empty() || line.front() == '#') return std::nullopt;
  AsciiCommand command;
  const auto refuse = [&command](Wrong why) {
    return std::unexpected{AsciiRefusal{command.sequence, why.error, std::move(why.why)}};
  };
  const auto rest = read_sequence(line, command.sequence);
  if (!rest) return refuse(rest.error());
  const auto words = split(*rest);
  if (!words) return refuse(words.error());
  if (auto good = read_line(*words, command); !good) return refuse(good.error());
  return command;
}

FirstLine judge_first_line(std::string_view line) {
  const auto command = parse_ascii(line);
  if (command) return *command ? FirstLine::command : FirstLine::nothing;
  return command.error().error == AsciiError::syntax ? FirstLine::foreign : FirstLine::command;
}

bool may_become_command(std::string_view beginning) noexcept {
  const std::size_t at = beginning.find_first_not_of(" \t\r");
  return at == beginning.npos || beginning[at] == '[' || beginning[at] == '#';
}

std::string_view ascii_help() noexcept {
  return R"(# [seq] [[net] node] r[ead] index sub [type]         SDO upload
# [seq] [[net] node] w[rite] index sub type value     SDO download
# [seq] [[net] node] r[ead] p[do] number              values of a TPDO as last received
# [seq] [[net] node] w[rite] p[do] number n value...  set-points of an RPDO
# [seq] [[net] node] start | stop | preop | reset node | reset comm      node 0: all
# [seq] set network | set node | set sdo_timeout value
# [seq] boot_up_indication Enable | Disable
# [seq] info version
# types: b i8..i64 u8..u64 x8..x64 r32 r64 vs hex; os us d in base64
# [seq] lss_switch_glob 0|1, lss_switch_sel vendor product revision serial
# [seq] lss_set_node id, lss_conf_bitrate [table] index, lss_store
# [seq] lss_inquire_addr [0..3 | 0x5A..0x5D], lss_get_node
# [seq] lss_identity vendor product revision-from -to serial-from -to, lss_ident_nonconf
# [seq] _lss_fastscan [timeout | number mask x 4], _lss_slowscan as lss_identity
# [seq] lss_allnodes [timeout [first store [type number] x 4]])";
}

}  // namespace takt
