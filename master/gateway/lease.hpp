#pragma once
#include <cstddef>
#include <cstdint>
#include <string>
#include <string_view>
#include <vector>

namespace takt {

/// How many cycles a command is good for, counted from cycle `now`. The shorter of the message's
/// time to live and the configured one counts; it runs from the cycle that the command was computed
/// from, so that commands which waited in a queue are old on arrival.
struct Freshness {
  bool fresh = true;
  std::uint32_t cycles = 0;  ///< left; 0 = no limit
};

struct CommandAge {
  std::uint64_t computed_from = 0;  ///< cycle of the image
  std::uint64_t now = 0;            ///< the cycle of this moment, by the clock
  std::uint32_t time_to_live = 0;   ///< of the message; 0 = it sets none
  std::uint32_t configured = 0;     ///< 0 = no limit
  std::uint32_t most = 1;           ///< one second: where none is configured
};

/// A command without any limit stays good once it is taken, but has to arrive within `most`.
Freshness freshness(const CommandAge& age) noexcept;

/// A program that commands: its instance decides, the name is for people.
struct Sender {
  std::int64_t instance = 0;
  std::string_view name;
};

/// Who may command the outputs of each node: the first sender does, until the time to live of its
/// newest command has run out or it has released the node. Counts in cycles; front thread.
class LeaseTable {
 public:
  /// `unlimited` is how long a command without time to live holds its node.
  LeaseTable(std::size_t nodes, std::uint32_t unlimited);

  /// True: `sender` holds the node now. `cycles` 0: no time to live.
  bool take(std::size_t node, const Sender& sender, std::uint64_t now, std::uint32_t cycles);
  /// True: the sender of this instance held the node, and now nobody does.
  bool release(std::size_t node, std::int64_t instance, std::uint64_t now) noexcept;
  /// Empty: nobody.
  std::string_view holder(std::size_t node, std::uint64_t now) const noexcept;
  /// Who held the node last, or does; empty: nobody so far.
  std::string_view last_holder(std::size_t node) const noexcept;

 private:
  struct Lease {
    std::int64_t instance = 0;
    std::string sender;
    std::uint64_t end = 0;  // first cycle that is free again
  };
  std::vector<Lease> leases_;
  std::uint32_t unlimited_;
};

}  // namespace takt
