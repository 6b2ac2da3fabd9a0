#pragma once
#include <cstdint>
#include <map>
#include <optional>
#include <string>
#include <utility>

#include "eds_parser/values/time.hpp"
#include "master/gateway/notice/notice.hpp"

namespace takt {

/// Limits the number of notices: for each kind and node, 16 at once and two per second in the long
/// run. Remembers as many entries as there are pairs of kind and node. All calls come from the
/// front thread.
class NoticeLimit {
 public:
  /// Returns std::nullopt if the notice must be withheld. Otherwise returns how many notices were
  /// withheld since the last one.
  std::optional<std::uint64_t> allow(const Notice& notice);

 private:
  struct Account {
    Time free_at{};  ///< time at which the cost of all notices so far is paid
    std::uint64_t kept_back = 0;
  };
  std::map<std::pair<std::string, std::uint8_t>, Account> accounts_;
};

}  // namespace takt
