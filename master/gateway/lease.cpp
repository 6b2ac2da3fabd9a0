#include "master/gateway/lease.hpp"

#include <algorithm>

namespace takt {

Freshness freshness(const CommandAge& age) noexcept {
  std::uint32_t limit = age.configured;
  if (age.time_to_live != 0) {
    limit = limit == 0 ? age.time_to_live : std::min(limit, age.time_to_live);
  }
  if (limit == 0) return {};
  const bool in_the_past = age.computed_from != 0 && age.computed_from < age.now;
  const std::uint64_t waited = in_the_past ? age.now - age.computed_from : 0;
  if (waited >= limit) return {.fresh = false, .cycles = 0};
  return {.fresh = true, .cycles = limit - static_cast<std::uint32_t>(waited)};
}

LeaseTable::LeaseTable(std::size_t nodes, std::uint32_t unlimited)
    : leases_(nodes), unlimited_{std::max(unlimited, 1U)} {}

bool LeaseTable::take(std::size_t node, std::string_view sender, std::uint64_t now,
                      std::uint32_t cycles) {
  if (node >= leases_.size()) return false;
  Lease& lease = leases_[node];
  const bool others = now < lease.end && lease.sender != sender;
  if (others) return false;
  if (lease.sender != sender) lease.sender = sender;
  lease.end = now + (cycles == 0 ? unlimited_ : cycles);
  return true;
}

std::string_view LeaseTable::holder(std::size_t node, std::uint64_t now) const noexcept {
  if (node >= leases_.size() || now >= leases_[node].end) return {};
  return leases_[node].sender;
}

}  // namespace takt
