#pragma once
#include <cstddef>
#include <cstdint>
#include <string>
#include <string_view>
#include <vector>

#include "master/core/command_limit.hpp"

namespace takt {

inline constexpr std::size_t longest_sender = 64;  ///< bytes of a sender's name

/// States for how many cycles, from cycle `now` on, a command is valid. The shorter of the time to
/// live of the message and the configured limit applies. The limit counts from the cycle of the
/// image from which the command was computed, so a command that waited in a queue is old on
/// arrival.
struct Freshness {
  bool fresh = true;
  std::uint32_t cycles = 0;  ///< remaining cycles; 0 means no limit
  CommandLimit limit{};      ///< the limit that applies, from the cycle of the image on
};

struct CommandAge {
  std::uint64_t computed_from = 0;  ///< cycle of the image
  std::uint64_t now = 0;            ///< present cycle by the clock
  std::uint32_t time_to_live = 0;   ///< time to live in the message; 0 if the message sets none
  std::uint32_t configured = 0;     ///< 0 means no limit
  std::uint32_t most = 1;           ///< cycles in one second; the limit if none is configured
};

/// A command without any limit stays valid once it is accepted, but must arrive within `most`.
Freshness freshness(const CommandAge& age) noexcept;

/// A program that sends commands. The instance identifies the program; the name is for the user.
struct Sender {
  std::int64_t instance = 0;
  std::string_view name;
};

/// The reason why a sender does not get a node.
enum class LeaseVerdict : std::uint8_t {
  taken,
  held,       ///< another sender holds the node
  overtaken,  ///< a command that was computed from a later cycle has been accepted before
  released,   ///< the command was computed from the cycle in which its sender has released the node
};

/// The cycles of a command. `cycles` is the number of cycles for which it is valid; 0 means no
/// limit.
struct LeaseTerm {
  std::uint64_t now = 0;
  std::uint32_t cycles = 0;
  std::uint64_t computed_from = 0;
  bool is_sign_of_life = false;  ///< a sign of life commands nothing, so a release may overtake it
};

/// Decides who may command the outputs of each node. The first sender holds the node until the time
/// to live of each of its commands has expired, or until it releases the node. A command must not
/// be computed from an earlier cycle than the newest accepted one of the node. Times count in
/// cycles. All calls come from the front thread.
class LeaseTable {
 public:
  /// `unlimited` is the number of cycles for which a command without time to live holds its node.
  LeaseTable(std::size_t nodes, std::uint32_t unlimited);

  /// Returns what take() would return.
  LeaseVerdict verdict(std::size_t node, const Sender& sender,
                       const LeaseTerm& term) const noexcept;
  /// Gives the node to `sender` if the verdict is `taken`.
  LeaseVerdict take(std::size_t node, const Sender& sender, const LeaseTerm& term);
  /// Returns true if the sender with this instance holds the node.
  bool holds(std::size_t node, std::int64_t instance, std::uint64_t now) const noexcept;
  /// Frees a node that its holder gives up. A sign of life that has overtaken the release changes
  /// nothing. Returns false if a later command has overtaken the release, or if the release is a
  /// copy of the last one.
  bool release(std::size_t node, std::uint64_t now, std::uint64_t computed_from) noexcept;
  /// Returns the name of the sender that holds the node; empty if no sender does.
  std::string_view holder(std::size_t node, std::uint64_t now) const noexcept;
  /// Returns the name of the sender that holds the node or held it last; empty if there was none.
  std::string_view last_holder(std::size_t node) const noexcept;

 private:
  struct Lease {
    std::int64_t instance = 0;
    std::string sender;
    std::uint64_t end = 0;      // first cycle in which the node is free again
    std::uint64_t newest = 0;   // cycle from which the newest command was computed
    std::uint64_t ordered = 0;  // cycle of the newest command that is no sign of life
    bool released = false;      // the command is a release
  };
  static LeaseVerdict judge(const Lease& lease, std::int64_t instance,
                            const LeaseTerm& term) noexcept;
  std::vector<Lease> leases_;
  std::uint32_t unlimited_;
};

}  // namespace takt
