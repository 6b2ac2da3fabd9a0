#pragma once
#include <cstdint>
#include <optional>
#include <span>

#include "apps/takt/soak/evidence/image_judge.hpp"
#include "eds_parser/table/bus_plan.hpp"
#include "master/wire/frame.hpp"

namespace takt::soak {

/// Mode (6061) in which a drive follows a target position in each cycle.
inline constexpr std::uint64_t cyclic_synchronous_position = 8;

/// Returns true if the drive is in Operation enabled.
constexpr bool is_enabled(std::uint64_t statusword) noexcept { return (statusword & 0x6F) == 0x27; }

/// Returns the value of a signal in a frame that may be one of these PDOs; empty if the frame does
/// not have it. A receiver ignores a frame that is shorter than its mapping.
template <class Rows>
std::optional<std::uint64_t> value_in(const BusPlan& plan, const Rows& rows, const Frame& frame,
                                      SignalIndex signal) {
  const PdoRow& row = rows[plan.layout.signals[signal].row];
  if (row.cob_id != frame.id || frame.length < row.length) return std::nullopt;
  for (const PdoField& field : plan.pdos.fields_of(row)) {
    if (field.signal == signal) return bits_of(frame, field.bit_offset, field.bits);
  }
  return std::nullopt;
}

/// Returns the value of an input in a TPDO.
inline std::optional<std::uint64_t> input_in(const BusPlan& plan, const Frame& frame,
                                             SignalIndex input) {
  if (plan.layout.signals[input].output) return std::nullopt;
  return value_in(plan, plan.pdos.tpdos, frame, input);
}

/// Returns the value of an output in an RPDO.
inline std::optional<std::uint64_t> output_in(const BusPlan& plan, const Frame& frame,
                                              SignalIndex output) {
  if (!plan.layout.signals[output].output) return std::nullopt;
  return value_in(plan, plan.pdos.rpdos, frame, output);
}

}  // namespace takt::soak
