#include "master/gateway/lease.hpp"

#include <algorithm>

namespace takt {

Freshness freshness(const CommandAge& age) noexcept {
  std::uint32_t limit = age.configured == 0 ? age.most : age.configured;
  if (age.time_to_live != 0) limit = std::min(limit, age.time_to_live);
  const std::uint64_t waited = age.computed_from < age.now ? age.now - age.computed_from : 0;
  if (waited >= limit) return {.fresh = false, .cycles = 0};
  const bool unlimited = age.configured == 0 && age.time_to_live == 0;
  return {.fresh = true, .cycles = unlimited ? 0 : limit - static_cast<std::uint32_t>(waited)};
}

LeaseTable::LeaseTable(std::size_t nodes, std::uint32_t unlimited)
    : leases_(nodes), unlimited_{std::max(unlimited, 1U)} {}

bool LeaseTable::take(std::size_t node, const Sender& sender, std::uint64_t now,
                      std::uint32_t cycles) {
  if (node >= leases_.size()) return false;
  Lease& lease = leases_[node];
  const bool others = now < lease.end && lease.instance != sender.instance;
  if (others) return false;
  lease.instance = sender.instance;
  if (lease.sender != sender.name) lease.sender = sender.name;
  lease.end = now + (cycles == 0 ? unlimited_ : cycles);
  return true;
}

bool LeaseTable::release(std::size_t node, std::int64_t instance, std::uint64_t now) noexcept {
  if (node >= leases_.size()) return false;
  Lease& lease = leases_[node];
  if (now >= lease.end || lease.instance != instance) return false;
  lease.end = 0;
  return true;
}

std::string_view LeaseTable::holder(std::size_t node, std::uint64_t now) const noexcept {
  if (node >= leases_.size() || now >= leases_[node].end) return {};
  return leases_[node].sender;
}

std::string_view LeaseTable::last_holder(std::size_t node) const noexcept {
  return node < leases_.size() ? std::string_view{leases_[node].sender} : std::string_view{};
}

}  // namespace takt
