#pragma once
#include <array>
#include <cstdint>
#include <nlohmann/json_fwd.hpp>
#include <optional>
#include <string>
#include <string_view>

#include "apps/takt/lss_access.hpp"

namespace takt {

/// The command line of the verbs of `takt lss`.
struct LssOptions {
  LssAccessOptions access;
  std::array<std::string, 4> parts;  ///< as typed: a number, or a range A-B of a scan
  bool alone = false;
  bool all = false;
  bool store = false;
  bool first = false;
  int node_id = 0;
  int kbit = 0;
  int delay_ms = 0;
  std::string state;
};

/// Both ends belong to it.
struct LssRange {
  std::uint32_t from = 0;
  std::uint32_t to = 0;
};

/// Decimal, or 0x hex.
std::optional<std::uint32_t> lss_number(std::string_view text);
/// A number, `A-B`, or nothing: all.
std::optional<LssRange> lss_range(const std::string& text);

/// Fastscan for a device without node id, with the numbers that are given.
LssCommand fast_scan(const LssOptions& options);
/// Brings the device that is meant into configuration state.
LssCommand selection(const LssOptions& options);
/// Who was meant, as far as that is known.
std::optional<LssAddress> device_of(const LssOptions& options, const LssResult& selected);

std::string device_text(const LssAddress& address);
nlohmann::json device_json(const LssAddress& address);

}  // namespace takt
