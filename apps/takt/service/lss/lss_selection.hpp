#pragma once
#include <array>
#include <cstdint>
#include <nlohmann/json_fwd.hpp>
#include <optional>
#include <string>

#include "apps/takt/service/lss/lss_access.hpp"

namespace takt {

/// The command line of the verbs of `takt lss`.
struct LssOptions {
  LssAccessOptions access;
  std::array<std::string, 4> parts;  ///< words as typed: a number, or a range A-B of a scan
  bool alone = false;
  bool all = false;
  bool store = false;
  bool first = false;
  int node_id = 0;
  int kbit = 0;
  int delay_ms = 0;
  std::string state;
};

/// A range of numbers that includes both ends.
struct LssRange {
  std::uint32_t from = 0;
  std::uint32_t to = 0;
};

/// Parses a number or a range `A-B`. An empty text means all numbers. Returns std::nullopt if the
/// text is no range.
std::optional<LssRange> lss_range(const std::string& text);

/// Returns a Fastscan for a device without node-ID that matches the given numbers.
LssCommand fast_scan(const LssOptions& options);
/// Returns the command that switches the chosen device to configuration state.
LssCommand selection(const LssOptions& options);
/// Returns the address of the chosen device. Returns std::nullopt if it is not known.
std::optional<LssAddress> device_of(const LssOptions& options, const LssResult& selected);

std::string device_text(const LssAddress& address);
nlohmann::json device_json(const LssAddress& address);

}  // namespace takt
