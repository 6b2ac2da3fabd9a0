#pragma once
#include <chrono>
#include <cstdint>
#include <fmt/format.h>
#include <span>
#include <string>
#include <string_view>

#include "eds_parser/table/bus_plan.hpp"
#include "eds_parser/values/ids.hpp"
#include "eds_parser/values/time.hpp"

namespace takt {

// These functions return parts of the texts of reports.

/// Returns the bytes as text: "37 06".
inline std::string bytes_text(std::span<const std::uint8_t> bytes) {
  return fmt::format("{:02X}", fmt::join(bytes, " "));
}

/// Returns a frame as text: "605  40 18 10 01 00 00 00 00".
inline std::string frame_text(CobId id, std::span<const std::uint8_t> bytes) {
  return fmt::format("{:03X}  {}", id.id(), bytes_text(bytes));
}

/// Returns an abort code as CiA 301 prints it: "0604 0041".
inline std::string abort_digits(std::uint32_t code) {
  return fmt::format("{:04X} {:04X}", code >> 16, code & 0xFFFF);
}

/// Returns a time as text: "2.5 s", "300 ms", "40 us".
inline std::string time_text(Time time) {
  const std::int64_t us = std::chrono::duration_cast<std::chrono::microseconds>(time).count();
  const auto text = [us](std::int64_t unit, std::int64_t tenth, std::string_view name) {
    const std::string tenths = tenth == 0 ? "" : fmt::format(".{}", tenth);
    return fmt::format("{}{} {}", us / unit, tenths, name);
  };
  if (us >= 1'000'000) return text(1'000'000, us / 100'000 % 10, "s");
  if (us >= 1'000) return text(1'000, us < 10'000 ? us / 100 % 10 : 0, "ms");
  return text(1, 0, "us");
}

/// Returns the argument of `--bus`: "can0".
inline std::string interface_text(const BusPlan& plan) {
  return plan.interface.empty() ? "can0" : plan.interface;
}

/// Returns a node as text: "node 5 'shoulder'".
inline std::string node_text(const NodePlan& node) {
  return fmt::format("node {} '{}'", node.id.value(), node.name);
}

/// Returns the known parts of an LSS address as text: "vendor id 0x0000015A, product code
/// 0x00000700, serial number 77".
inline std::string identity_text(const LssPlan& lss) {
  std::string text =
      fmt::format("vendor id 0x{:08X}, product code 0x{:08X}", lss.address[0], lss.address[1]);
  if (lss.known[2] != 0) text += fmt::format(", revision number 0x{:08X}", lss.address[2]);
  if (lss.known[3] != 0) text += fmt::format(", serial number {}", lss.address[3]);
  return text;
}

}  // namespace takt
