#include <array>

#include "master/gateway/ascii/ascii_words.hpp"

// LSS commands of CiA 309-3. Those that begin with `_` come from Lely and CANopenNode.

namespace takt::ascii {
namespace {

/// Reads `count` numbers behind the command name.
Read<void> lss_numbers(Words words, std::size_t count, AsciiCommand& out) {
  for (std::size_t i = 0; i < count; ++i) {
    const auto value = number(words, 1 + i, 0xFFFF'FFFF, "number");
    if (!value) return std::unexpected{value.error()};
    out.lss.numbers[i] = *value;
  }
  return end_at(words, 1 + count);
}

Read<void> lss_byte(Words words, std::uint32_t most, AsciiCommand& out) {
  const auto value = number(words, 1, most, "number");
  if (!value) return std::unexpected{value.error()};
  out.lss.a = static_cast<std::uint8_t>(*value);
  return end_at(words, 2);
}

Read<void> lss_bit_rate(Words words, AsciiCommand& out) {
  const bool has_table = words.size() > 2;
  const auto table = has_table ? number(words, 1, 255, "table") : Read<std::uint32_t>{0};
  const auto entry = number(words, has_table ? 2 : 1, 255, "table index");
  if (!table || !entry) return std::unexpected{(!table ? table : entry).error()};
  out.lss.a = static_cast<std::uint8_t>(*table);
  out.lss.b = static_cast<std::uint8_t>(*entry);
  return end_at(words, has_table ? 3 : 2);
}

/// Reads a part of the LSS address, either by number as in CANopenNode's gateway or by the code of
/// its LSS request as in Lely's.
Read<void> lss_inquire(Words words, AsciiCommand& out) {
  constexpr std::uint32_t first_code = 0x5A;
  constexpr std::uint32_t parts = 4;
  out.lss.op = LssOp::inquire_vendor;
  out.lss_all_parts = words.size() == 1;
  if (out.lss_all_parts) return {};
  const auto given = parse_ascii_integer(words[1].text).value_or(-1);
  const bool is_code = given >= first_code && given < first_code + parts;
  if (!is_code && (given < 0 || given >= parts)) {
    return wrong(
        "expected a part of the LSS address, 0 vendor id, 1 product code, 2 revision "
        "number, 3 serial number (or 0x5A..0x5D), not '" +
        words[1].text + "'");
  }
  const auto part = static_cast<unsigned>(is_code ? given - first_code : given);
  out.lss.op = static_cast<LssOp>(static_cast<unsigned>(LssOp::inquire_vendor) + part);
  return end_at(words, 2);
}

/// Reads nothing, a time-out in ms, or an LSS address with a mask behind each part.
Read<void> lss_fast_scan(Words words, AsciiCommand& out) {
  if (words.size() <= 2) {
    if (words.size() == 1) return {};
    const auto timeout = number(words, 1, 60'000, "time-out");
    if (!timeout) return std::unexpected{timeout.error()};
    out.lss_timeout_ms = *timeout;
    return {};
  }
  if (auto good = lss_numbers(words, 8, out); !good) return good;
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
  out.lss.op = LssOp::fast_scan;
  if (words.size() > most ||
      (words.size() != 1 && words.size() != 2 && words.size() != 4 && words.size() != most)) {
    return wrong("expected [time-out [first store [type number] x 4]]");
  }
  for (std::size_t i = 1; i < words.size(); ++i) {
    const auto value = number(words, i, 0xFFFF'FFFF, "number");
    if (!value) return std::unexpected{value.error()};
    given[i - 1] = *value;
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

}  // namespace

Read<void> read_lss(Words words, AsciiCommand& out) {
  const Word& name = words[0];
  out.verb = AsciiVerb::lss;
  const auto plain = [&](LssOp op) {
    out.lss.op = op;
    return end_at(words, 1);
  };
  if (is(name, "lss_switch_glob")) return lss_byte(words, 1, out);
  if (is(name, "lss_switch_sel")) {
    out.lss.op = LssOp::switch_selective;
    return lss_numbers(words, 4, out);
  }
  if (is(name, "lss_set_node")) {
    out.lss.op = LssOp::configure_node_id;
    return lss_byte(words, 255, out);
  }
  if (is(name, "lss_conf_bitrate")) {
    out.lss.op = LssOp::configure_bit_timing;
    return lss_bit_rate(words, out);
  }
  if (is(name, "lss_store")) return plain(LssOp::store);
  if (is(name, "lss_inquire_addr")) return lss_inquire(words, out);
  if (is(name, "lss_get_node")) return plain(LssOp::inquire_node_id);
  if (is(name, "lss_identity") || is(name, "_lss_slowscan")) {
    out.lss.op = is(name, "lss_identity") ? LssOp::identify : LssOp::slow_scan;
    return lss_numbers(words, 6, out);
  }
  if (is(name, "lss_ident_nonconf", "lss_identity_nonconf")) {
    return plain(LssOp::identify_unconfigured);
  }
  if (is(name, "_lss_fastscan")) {
    out.lss.op = LssOp::fast_scan;
    return lss_fast_scan(words, out);
  }
  if (is(name, "lss_allnodes")) return lss_all_nodes(words, out);
  return unsupported("'" + name.text +
                     "' is not offered; a bit rate is activated with taktd "
                     "stopped (takt lss set-bitrate)");
}

}  // namespace takt::ascii
