#include <array>

#include "master/gateway/ascii/ascii_words.hpp"

// LSS commands of CiA 309-3. Those that begin with `_` come from Lely and CANopenNode.

namespace takt::ascii {
namespace {

/// Reads `count` numbers behind the command name.
template <std::size_t count>
Read<void> lss_numbers(Words words, AsciiCommand& out) {
  for (std::size_t i = 0; i < count; ++i) {
    if (auto good = number(words, 1 + i, 0xFFFF'FFFF, "number", out.lss.numbers[i]); !good)
      return good;
  }
  return end_at(words, 1 + count);
}

template <std::uint32_t most>
Read<void> lss_byte(Words words, AsciiCommand& out) {
  if (auto good = number(words, 1, most, "number", out.lss.a); !good) return good;
  return end_at(words, 2);
}

Read<void> lss_bit_rate(Words words, AsciiCommand& out) {
  const std::size_t entry = words.size() > 2 ? 2 : 1;
  if (entry == 2) {
    if (auto good = number(words, 1, 255, "table", out.lss.a); !good) return good;
  }
  if (auto good = number(words, entry, 255, "table index", out.lss.b); !good) return good;
  return end_at(words, entry + 1);
}

/// Reads a part of the LSS address, either by number as in CANopenNode's gateway or by the code of
/// its LSS request as in Lely's.
Read<void> lss_inquire(Words words, AsciiCommand& out) {
  constexpr std::uint32_t first_code = 0x5A;
  constexpr std::uint32_t parts = 4;
  out.lss_all_parts = words.size() == 1;
  if (out.lss_all_parts) return {};
  const auto given = parse_ascii_integer(words[1].text).value_or(-1);
  const bool is_code = given >= first_code && given < first_code + parts;
  if (!is_code && (given < 0 || given >= parts)) {
    return wrong(
        "expected a part of the LSS address, 0 vendor id, 1 product code, 2 revision number, 3 "
        "serial number (or 0x5A..0x5D), not '" +
        words[1].text + "'");
  }
  const auto part = static_cast<unsigned>(is_code ? given - first_code : given);
  out.lss.op = static_cast<LssOp>(static_cast<unsigned>(LssOp::inquire_vendor) + part);
  return end_at(words, 2);
}

/// Reads nothing, a time-out in ms, or an LSS address with a mask behind each part.
Read<void> lss_fast_scan(Words words, AsciiCommand& out) {
  if (words.size() == 1) return {};
  if (words.size() == 2) return number(words, 1, 60'000, "time-out", out.lss_timeout_ms);
  if (auto good = lss_numbers<8>(words, out); !good) return good;
  const auto given = out.lss.numbers;
  for (std::size_t i = 0; i < 4; ++i) {
    out.lss.numbers[i] = given[2 * i];
    out.lss.numbers[4 + i] = given[2 * i + 1];
  }
  return {};
}

/// Reads the time-out, the first node-ID and the store flag, then for each part of the address a
/// type (0 scan, 1 ignore, 2 match) and a number.
Read<void> lss_all_nodes(Words words, AsciiCommand& out) {
  constexpr std::size_t most = 12;
  std::array<std::uint32_t, most> given{0, 2, 0};
  out.verb = AsciiVerb::lss_all_nodes;
  if (words.size() != 1 && words.size() != 2 && words.size() != 4 && words.size() != most) {
    return wrong("expected [time-out [first store [type number] x 4]]");
  }
  for (std::size_t i = 1; i < words.size(); ++i) {
    if (auto good = number(words, i, 0xFFFF'FFFF, "number", given[i - 1]); !good) return good;
  }
  if (given[0] > 60'000 || given[1] < 1 || given[1] > 127) {
    return wrong("the time-out is 0..60000 ms, the first node id 1..127");
  }
  out.lss_timeout_ms = given[0];
  out.number = given[1];
  out.store = given[2] != 0;
  for (std::size_t i = 0; i < 4; ++i) {
    const bool known = given[3 + 2 * i] == 2;
    out.lss.numbers[i] = known ? given[4 + 2 * i] : 0;
    out.lss.numbers[4 + i] = known ? 0xFFFF'FFFF : 0;
  }
  return {};
}

struct LssRow {
  std::string_view name;
  LssOp op;
  Reader read;
};
constexpr LssRow lss_commands[] = {
    {"lss_switch_glob", LssOp::switch_global, lss_byte<1>},
    {"lss_switch_sel", LssOp::switch_selective, lss_numbers<4>},
    {"lss_set_node", LssOp::configure_node_id, lss_byte<255>},
    {"lss_conf_bitrate", LssOp::configure_bit_timing, lss_bit_rate},
    {"lss_store", LssOp::store, read_nothing},
    {"lss_inquire_addr", LssOp::inquire_vendor, lss_inquire},
    {"lss_get_node", LssOp::inquire_node_id, read_nothing},
    {"lss_identity", LssOp::identify, lss_numbers<6>},
    {"lss_ident_nonconf", LssOp::identify_unconfigured, read_nothing},
    {"lss_identity_nonconf", LssOp::identify_unconfigured, read_nothing},
    {"lss_allnodes", LssOp::fast_scan, lss_all_nodes},
    {"_lss_fastscan", LssOp::fast_scan, lss_fast_scan},
    {"_lss_slowscan", LssOp::slow_scan, lss_numbers<6>}};

}  // namespace

Read<void> read_lss(Words words, AsciiCommand& out) {
  out.verb = AsciiVerb::lss;
  for (const LssRow& row : lss_commands) {
    if (!is(words[0], row.name)) continue;
    out.lss.op = row.op;
    return row.read(words, out);
  }
  return unsupported("'" + words[0].text +
                     "' is not possible while taktd runs: stop taktd, and activate the bit rate "
                     "with takt lss set-bitrate");
}

}  // namespace takt::ascii
