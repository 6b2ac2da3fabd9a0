#pragma once
#include <cstddef>
#include <expected>
#include <span>
#include <string>
#include <vector>

#include "eds_parser/values/ids.hpp"

namespace takt {

/// One value of a concise DCF with its bytes as they are sent on the wire.
struct ConciseEntry {
  ObjectKey object;
  std::vector<std::byte> value;
  bool operator==(const ConciseEntry&) const = default;
};

/// Reads the content of 0x1F22: a list of values in the order in which they are to be written.
/// Surplus bytes are ignored. If bytes are missing, the function returns an error text. CiA 302-3.
std::expected<std::vector<ConciseEntry>, std::string> decode_concise_dcf(
    std::span<const std::byte> bytes);

std::vector<std::byte> encode_concise_dcf(std::span<const ConciseEntry> entries);

}  // namespace takt
