#pragma once
#include <cstdint>
#include <expected>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "eds_parser/table/boot_plan.hpp"
#include "eds_parser/values/ids.hpp"
#include "master/core/lss/lss_command.hpp"
#include "master/gateway/ascii/ascii_value.hpp"

namespace takt {

/// Internal error codes of CiA 309-3.
enum class AsciiError : std::uint16_t {
  not_supported = 100,
  syntax = 101,
  internal_state = 102,
  timeout = 103,
  no_default_net = 104,
  no_default_node = 105,
  unsupported_net = 106,
  unsupported_node = 107,
  guarding_lost = 200,
  heartbeat_started = 202,
  heartbeat_lost = 203,
  error_passive = 300,
  bus_off = 301,
  buffer_overflow = 303,
  pdo_length = 401,
  lss_manufacturer = 501,
  lss_node_id = 502,
  lss_bit_rate = 503,
  lss_store = 504,
  lss_media = 505,
};
std::string_view text(AsciiError error) noexcept;

enum class AsciiVerb : std::uint8_t {
  // commands to a node
  sdo_read,
  sdo_write,
  pdo_read,
  pdo_write,
  nmt,
  // commands about the network
  set_network,
  set_node,
  set_sdo_timeout,
  boot_up_indication,
  info_version,
  help,
  lss,
  lss_all_nodes,
};

/// One line of a client: `[seq] [[net] node] command`.
struct AsciiCommand {
  std::uint32_t sequence = 0;
  std::optional<std::uint32_t> net;
  std::optional<std::uint32_t> node;
  AsciiVerb verb = AsciiVerb::help;
  ObjectKey object{};
  AsciiType type{};
  std::vector<std::byte> value;  ///< value of an SDO write
  NmtCommand nmt = NmtCommand::start;
  /// The number that the verb needs: a PDO number, a default, a time-out in ms, the first node-ID,
  /// or 1 for "enable".
  std::uint32_t number = 0;
  std::vector<std::int64_t> values;  ///< values of a PDO
  LssCommand lss{};
  std::uint32_t lss_timeout_ms = 0;  ///< 0 selects the default
  bool lss_all_parts = false;        ///< the command inquires the whole LSS address
  bool store = false;
};

struct AsciiRefusal {
  std::uint32_t sequence = 0;
  AsciiError error = AsciiError::syntax;
  std::string why;
};

/// Returns std::nullopt for an empty line or a comment. `line` may hold any bytes, without the line
/// break.
std::expected<std::optional<AsciiCommand>, AsciiRefusal> parse_ascii(std::string_view line);

/// Kind of the first line of a client. An HTTP request, a TLS hello and the like are foreign, and
/// so is a line with a syntax error: such a client speaks another protocol.
enum class FirstLine : std::uint8_t { command, nothing, foreign };
FirstLine judge_first_line(std::string_view line);
/// Returns false if `beginning`, the start of a line, cannot become a command or a comment.
bool may_become_command(std::string_view beginning) noexcept;

/// Returns the answer to `help`.
std::string_view ascii_help() noexcept;

}  // namespace takt
