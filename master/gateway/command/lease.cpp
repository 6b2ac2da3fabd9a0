#include "master/gateway/command/lease.hpp"

#include <algorithm>

namespace takt {

Freshness freshness(const CommandAge& age) noexcept {
  std::uint32_t limit = age.configured == 0 ? age.most : age.configured;
  if (age.time_to_live != 0) limit = std::min(limit, age.time_to_live);
  const std::uint64_t waited = age.computed_from < age.now ? age.now - age.computed_from : 0;
  if (waited >= limit) return {.fresh = false};
  if (age.configured == 0 && age.time_to_live == 0) return {.fresh = true};
  const bool configured = age.configured != 0 && limit == age.configured;
  return {.fresh = true,
          .cycles = limit - static_cast<std::uint32_t>(waited),
          .limit = {.cycles = limit,
                    .origin = configured ? LimitOrigin::configured : LimitOrigin::command}};
}

LeaseTable::LeaseTable(std::size_t nodes, std::uint32_t unlimited)
    : leases_(nodes), unlimited_{std::max(unlimited, 1U)} {}

/// Decides about a command of a sender that may hold the node. The newest accepted command does not
/// count if it is from a cycle that has not begun yet: the cycle that is expected by the clock
/// becomes smaller when SYNC was missing. A command of the cycle in which its sender has released
/// the node was sent before the release.
LeaseVerdict LeaseTable::judge(const Lease& lease, std::int64_t instance,
                               const LeaseTerm& term) noexcept {
  if (lease.newest > term.now + 1) return LeaseVerdict::taken;
  if (term.computed_from < lease.newest) return LeaseVerdict::overtaken;
  const bool released =
      lease.released && lease.instance == instance && term.computed_from == lease.ordered;
  return released ? LeaseVerdict::released : LeaseVerdict::taken;
}

LeaseVerdict LeaseTable::verdict(std::size_t node, const Sender& sender,
                                 const LeaseTerm& term) const noexcept {
  if (node >= leases_.size()) return LeaseVerdict::held;
  const Lease& lease = leases_[node];
  const bool others = term.now < lease.end && lease.instance != sender.instance;
  return others ? LeaseVerdict::held : judge(lease, sender.instance, term);
}

LeaseVerdict LeaseTable::take(std::size_t node, const Sender& sender, const LeaseTerm& term) {
  const LeaseVerdict found = verdict(node, sender, term);
  if (found != LeaseVerdict::taken) return found;
  Lease& lease = leases_[node];
  const bool goes_on = lease.instance == sender.instance && lease.newest <= term.now + 1;
  const std::uint64_t end = term.now + (term.cycles == 0 ? unlimited_ : term.cycles);
  lease.end = goes_on ? std::max(lease.end, end) : end;
  lease.instance = sender.instance;
  if (lease.sender != sender.name) lease.sender = sender.name;
  lease.newest = term.computed_from;
  if (term.is_sign_of_life && goes_on) return LeaseVerdict::taken;
  lease.ordered = term.computed_from;
  lease.released = false;
  return LeaseVerdict::taken;
}

bool LeaseTable::holds(std::size_t node, std::int64_t instance, std::uint64_t now) const noexcept {
  return node < leases_.size() && now < leases_[node].end && leases_[node].instance == instance;
}

bool LeaseTable::release(std::size_t node, std::uint64_t now,
                         std::uint64_t computed_from) noexcept {
  if (node >= leases_.size()) return false;
  Lease& lease = leases_[node];
  const bool judges = lease.newest <= now + 1;
  const bool is_copy = lease.released && computed_from == lease.ordered;
  if (judges && (computed_from < lease.ordered || is_copy)) return false;
  lease.end = 0;
  lease.newest = judges ? std::max(lease.newest, computed_from) : computed_from;
  lease.ordered = computed_from;
  lease.released = true;
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
