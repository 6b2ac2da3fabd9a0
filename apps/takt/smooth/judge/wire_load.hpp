#pragma once
#include <cstdint>

#include "apps/takt/smooth/judge/bus_record.hpp"
#include "master/wire/frame.hpp"

namespace takt::smooth {

/// Returns the length of a frame on the wire in bits, including the interframe space, with average
/// bit stuffing.
std::uint16_t wire_bits(const Frame& frame) noexcept;

/// Returns the share of the time from `from` to `until` in which the wire was busy, 0..1. The bit
/// rate of the record must be known.
double wire_load(const BusRecord& bus, Time from, Time until);

/// Guesses the bit rate from frames that follow each other without a pause. Returns 0 if there are
/// too few of them.
std::uint32_t guessed_bitrate(const std::vector<WireFrame>& frames);

}  // namespace takt::smooth
