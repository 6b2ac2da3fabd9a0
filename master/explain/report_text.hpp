#pragma once
#include <chrono>
#include <cstdint>
#include <span>
#include <string>
#include <string_view>

#include "eds_parser/table/bus_plan.hpp"
#include "eds_parser/table/ids.hpp"
#include "eds_parser/table/time.hpp"

namespace takt {

// Parts of the texts of reports.

/// A frame as text: "605  40 18 10 01 00 00 00 00".
inline std::string frame_text(CobId id, std::span<const std::uint8_t> bytes) {
  std::string text = hex(id.id(), 3).substr(2) + " ";
  for (const std::uint8_t byte : bytes) text += " " + hex(byte, 2).substr(2);
  return text;
}

/// An abort code as CiA 301 prints it: "0604 0041".
inline std::string abort_digits(std::uint32_t code) {
  const std::string digits = hex(code, 8).substr(2);
  return digits.substr(0, 4) + " " + digits.substr(4);
}

/// A time as text: "2.5 s", "300 ms", "40 us".
inline std::string time_text(Time time) {
  const auto count = [](std::int64_t whole, std::int64_t tenth, std::string_view unit) {
    std::string text = std::to_string(whole);
    if (tenth != 0) text += "." + std::to_string(tenth);
    return text.append(" ").append(unit);
  };
  const std::int64_t us = std::chrono::duration_cast<std::chrono::microseconds>(time).count();
  if (us >= 1'000'000) return count(us / 1'000'000, us / 100'000 % 10, "s");
  if (us >= 1'000) return count(us / 1'000, us < 10'000 ? us / 100 % 10 : 0, "ms");
  return count(us, 0, "us");
}

/// The argument of `--bus`: "can0".
inline std::string interface_text(const BusPlan& plan) {
  return plan.interface.empty() ? "can0" : plan.interface;
}

/// A node as text: "node 5 'shoulder'".
inline std::string node_text(const NodePlan& node) {
  return "node " + std::to_string(int{node.id.value()}) + " '" + node.name + "'";
}

/// The known parts of an LSS address as text: "vendor id 0x0000015A, product code 0x00000700,
/// serial number 77".
inline std::string identity_text(const LssPlan& lss) {
  std::string text =
      "vendor id " + hex(lss.address[0], 8) + ", product code " + hex(lss.address[1], 8);
  if (lss.known[2] != 0) text += ", revision number " + hex(lss.address[2], 8);
  if (lss.known[3] != 0) text += ", serial number " + std::to_string(lss.address[3]);
  return text;
}

}  // namespace takt
