#pragma once
#include <cstddef>
#include <cstdint>
#include <string>
#include <string_view>
#include <vector>

namespace takt {

/// How many cycles a command is good for, counted from cycle `now`. The shorter of the message's
/// time to live and the configured one counts, 0 is "no limit"; it runs from the cycle that the
/// command was computed from, so that commands which waited in a queue are old on arrival.
struct Freshness {
  bool fresh = true;
  std::uint32_t cycles = 0;  ///< left; 0 = no limit
};

struct CommandAge {
  std::uint64_t computed_from = 0;  ///< cycle of the image; 0 = not said
  std::uint64_t now = 0;            ///< newest cycle
  std::uint32_t time_to_live = 0;   ///< of the message
  std::uint32_t configured = 0;
};

Freshness freshness(const CommandAge& age) noexcept;

/// Who may command the outputs of each node: the first sender does, until the time to live of its
/// newest command has run out. Counts in cycles; front thread.
class LeaseTable {
 public:
  /// `unlimited` is how long a command without time to live holds its node.
  LeaseTable(std::size_t nodes, std::uint32_t unlimited);

  /// True: `sender` holds the node now. `cycles` 0: no time to live.
  bool take(std::size_t node, std::string_view sender, std::uint64_t now, std::uint32_t cycles);
  /// Empty: nobody.
  std::string_view holder(std::size_t node, std::uint64_t now) const noexcept;

 private:
  struct Lease {
    std::string sender;
    std::uint64_t end = 0;  // first cycle that is free again
  };
  std::vector<Lease> leases_;
  std::uint32_t unlimited_;
};

}  // namespace takt
