#pragma once
#include <optional>
#include <string>
#include <string_view>

#include "master/gateway/notice/notice.hpp"

namespace takt {

/// Returns one text for two that say the same of two subjects, for example "node 1 'x', node 2 'y':
/// the node is lost". Returns std::nullopt if they do not, if one of them has several lines, or if
/// the subjects become too many for a line.
std::optional<std::string> merged_text(std::string_view first, std::string_view second);

/// Longest time between two notices of one cause.
inline constexpr Time same_cause = std::chrono::milliseconds{100};

/// Makes one line of notices that have one cause: of the same kind, at nearly the same time, with
/// the same text for several nodes or axes. All calls come from the front thread.
class MergedNotices {
 public:
  /// Takes a notice, and keeps it to merge it with the next ones. Returns the notice that was kept
  /// before if the new one has another cause.
  std::optional<Notice> add(const Notice& notice);
  /// Returns the notice that is kept, if there is one.
  std::optional<Notice> take();

 private:
  std::optional<Notice> kept_;
};

}  // namespace takt
