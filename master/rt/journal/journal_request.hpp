#pragma once
#include <array>
#include <cstdint>
#include <span>

#include "master/core/request.hpp"
#include "master/rt/journal/journal.hpp"

namespace takt {

/// The transfers of an Exchange, or those that a replay uses instead.
using SdoTransfers = std::array<SdoTransfer, 4>;

/// Records an accepted request, with the value of a long download. Records a gap if the value is
/// longer than 64 KiB or than the journal has room for; a replay cannot pass the gap. Bus thread.
void put_request(Journal& journal, const Request& request, const SdoTransfers& transfers) noexcept;

/// Reads a request from a record; `words` are the words of the record after its first word. Returns
/// false if they do not form a request.
bool get_request(std::span<const std::uint64_t> words, Request& request, SdoTransfers& transfers);

}  // namespace takt
