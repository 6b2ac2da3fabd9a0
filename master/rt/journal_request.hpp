#pragma once
#include <array>
#include <cstddef>
#include <cstdint>
#include <span>

#include "master/core/request.hpp"
#include "master/rt/journal.hpp"

namespace takt {

/// The transfers of an Exchange, or those of a replay in their place.
using SdoTransfers = std::array<SdoTransfer, 4>;

/// Writes down an accepted request, with the value of a long download. A gap where the value has
/// more than 64 KiB, or more than the journal has room for: what follows can't be replayed. Bus
/// thread.
void put_request(Journal& journal, const Request& request, const SdoTransfers& transfers) noexcept;

/// The request of a record; `words` are those behind its first. False: not a request.
bool get_request(std::span<const std::uint64_t> words, Request& request, SdoTransfers& transfers);

}  // namespace takt
