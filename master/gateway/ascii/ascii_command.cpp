#include "master/gateway/ascii/ascii_command.hpp"

#include <algorithm>
#include <fmt/format.h>
#include <utility>

#include "master/core/request.hpp"
#include "master/gateway/ascii/ascii_words.hpp"

namespace takt {
namespace {

using namespace ascii;

Read<void> read_object(Words words, AsciiCommand& out) {
  if (auto good = number(words, 1, 0xFFFF, "index", out.object.index); !good) return good;
  return number(words, 2, 0xFF, "sub-index", out.object.sub);
}

Read<void> read_type(Words words, AsciiCommand& out) {
  const auto type = parse_ascii_type(words[3].text);
  if (!type) return unsupported("data type '" + words[3].text + "' is not known");
  out.type = *type;
  return {};
}

Read<void> read_pdo(Words words, AsciiCommand& out) {
  if (auto good = number(words, 2, 512, "PDO number", out.number); !good) return good;
  if (out.verb == AsciiVerb::pdo_read) return end_at(words, 3);
  const auto count = number(words, 3, 64, "number of values");
  if (!count) return std::unexpected{count.error()};
  for (std::size_t i = 0; i < *count; ++i) {
    const auto value = 4 + i < words.size() ? parse_ascii_integer(words[4 + i].text) : std::nullopt;
    if (!value) return wrong(fmt::format("expected value {}", i + 1));
    out.values.push_back(*value);
  }
  return end_at(words, 4 + *count);
}

bool is_pdo(Words words) { return is_second(words, "p", "pdo"); }

Read<void> read_read(Words words, AsciiCommand& out) {
  if (is_pdo(words)) out.verb = AsciiVerb::pdo_read;
  if (is_pdo(words)) return read_pdo(words, out);
  if (auto good = read_object(words, out); !good) return good;
  if (words.size() < 4) return {};
  if (auto good = read_type(words, out); !good) return good;
  return end_at(words, 4);
}

Read<void> read_write(Words words, AsciiCommand& out) {
  if (is_pdo(words)) out.verb = AsciiVerb::pdo_write;
  if (is_pdo(words)) return read_pdo(words, out);
  if (auto good = read_object(words, out); !good) return good;
  if (words.size() < 5) return wrong("expected data type and value");
  if (auto good = read_type(words, out); !good) return good;
  std::string value = words[4].text;
  const bool joins = out.type.form == AsciiType::Form::hex && is_bytes(out.type.type);
  for (std::size_t i = 5; joins && i < words.size(); ++i) value += words[i].text;
  auto bytes = ascii_bytes(out.type, value);
  if (!bytes) return wrong(bytes.error());
  if (bytes->size() > request_bytes) {
    return unsupported(fmt::format("a value has at most {} bytes here", request_bytes));
  }
  out.value = std::move(*bytes);
  return joins ? Read<void>{} : end_at(words, 5);
}

template <NmtCommand command>
Read<void> read_nmt(Words words, AsciiCommand& out) {
  out.nmt = command;
  return end_at(words, 1);
}

Read<void> read_reset(Words words, AsciiCommand& out) {
  const bool whole = is_second(words, "node", "node");
  if (!whole && !is_second(words, "comm", "communication")) {
    return wrong("expected 'node' or 'comm'");
  }
  out.nmt = whole ? NmtCommand::reset_node : NmtCommand::reset_communication;
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
    if (auto good = number(words, 2, setting.most, "value", out.number); !good) return good;
    return end_at(words, 3);
  }
  return unsupported("'set " + words[1].text +
                     "' is not possible while taktd runs: the network file has this setting");
}

Read<void> read_indication(Words words, AsciiCommand& out) {
  const bool enables = is_second(words, "enable", "enable");
  if (!enables && !is_second(words, "disable", "disable")) {
    return wrong("expected Enable or Disable");
  }
  out.number = enables ? 1 : 0;
  return end_at(words, 2);
}

Read<void> read_info(Words words, AsciiCommand&) {
  if (!is_second(words, "version", "version")) return wrong("expected 'version'");
  return end_at(words, 2);
}

Read<void> read_help(Words, AsciiCommand&) { return {}; }

Read<void> refuse_setting(Words words, AsciiCommand&) {
  return unsupported("'" + words[0].text +
                     "' is not possible while taktd runs: the network file has this setting");
}

/// The commands of CiA 309-3 except those of LSS. A reader may select a more specific verb.
struct Command {
  std::string_view short_form;
  std::string_view full;
  AsciiVerb verb;
  Reader read;
};
constexpr Command command_table[] = {
    {"r", "read", AsciiVerb::sdo_read, read_read},
    {"w", "write", AsciiVerb::sdo_write, read_write},
    {"start", "start", AsciiVerb::nmt, read_nmt<NmtCommand::start>},
    {"stop", "stop", AsciiVerb::nmt, read_nmt<NmtCommand::stop>},
    {"preop", "preoperational", AsciiVerb::nmt, read_nmt<NmtCommand::enter_preoperational>},
    {"reset", "reset", AsciiVerb::nmt, read_reset},
    {"set", "set", AsciiVerb::set_node, read_set},
    {"boot_up_indication", "boot_up_indication", AsciiVerb::boot_up_indication, read_indication},
    {"info", "info", AsciiVerb::info_version, read_info},
    {"help", "help", AsciiVerb::help, read_help},
    {"enable", "enable", AsciiVerb::help, refuse_setting},
    {"disable", "disable", AsciiVerb::help, refuse_setting},
    {"init", "init", AsciiVerb::help, refuse_setting}};

Read<void> read_command(Words words, AsciiCommand& out) {
  const Word& name = words[0];
  for (const Command& command : command_table) {
    if (!is(name, command.short_form, command.full)) continue;
    out.verb = command.verb;
    return command.read(words, out);
  }
  if (name.text.starts_with("lss_") || name.text.starts_with("_lss_")) return read_lss(words, out);
  return wrong("no command '" + name.text + "'; 'help' lists the commands");
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

bool about_network(AsciiVerb verb) noexcept { return verb > AsciiVerb::nmt; }

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
  if (about_network(out.verb)) {
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
  using enum AsciiError;
  struct Text {
    AsciiError error;
    std::string_view text;
  };
  static constexpr Text texts[] = {{not_supported, "request not supported"},
                                   {syntax, "syntax error"},
                                   {internal_state, "request not processed due to internal state"},
                                   {timeout, "time-out"},
                                   {no_default_net, "no default net set"},
                                   {no_default_node, "no default node set"},
                                   {unsupported_net, "unsupported net"},
                                   {unsupported_node, "unsupported node"},
                                   {guarding_lost, "lost guarding message"},
                                   {heartbeat_started, "heartbeat started"},
                                   {heartbeat_lost, "heartbeat lost"},
                                   {error_passive, "error passive"},
                                   {bus_off, "bus off"},
                                   {buffer_overflow, "CAN buffer overflow"},
                                   {pdo_length, "PDO length exceeded"},
                                   {lss_manufacturer, "LSS manufacturer-specific error"},
                                   {lss_node_id, "LSS node-ID not supported"},
                                   {lss_bit_rate, "LSS bit-rate not supported"},
                                   {lss_store, "LSS parameter storing failed"},
                                   {lss_media, "LSS command failed because of media error"}};
  const auto found = std::ranges::find(texts, error, &Text::error);
  return found == std::end(texts) ? "unknown error" : found->text;
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
