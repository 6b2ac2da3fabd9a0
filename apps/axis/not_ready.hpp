#pragma once
#include <cstdint>
#include <string>
#include <takt/axis.hpp>
#include <vector>

namespace takt {

/// Returns a text that says why an axis is not known to be in this mode of operation (CiA 402-2,
/// 0x6060 and 0x6061), and what the user can do about it. The text is empty if the axis is in the
/// mode.
std::string mode_hint(const AxisSignals& signals, const ImageInput& input, DriveMode mode);

/// Returns a text that names the bits of the statusword which show why a drive is not in Operation
/// enabled. The text is empty if the drive is in that state.
std::string blocking_bits(std::uint16_t statusword);

/// Returns the newest EMCY of a node in words, or an empty text if none has come.
std::string newest_error(const node_status_t& node);

/// Returns lines that explain why this axis is not ready to move in this mode of operation: its
/// device, the bits of its statusword, its error, its mode, and the program that holds it. Returns
/// no lines if the axis is ready.
std::vector<std::string> why_not_ready(const AxisGroup& group, AxisControl::Index axis,
                                       DriveMode mode = DriveMode::cyclic_position);

}  // namespace takt
