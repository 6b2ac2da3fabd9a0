#pragma once
#include <cstdint>
#include <map>
#include <optional>
#include <string>
#include <utility>

#include "eds_parser/table/time.hpp"
#include "master/gateway/notice.hpp"

namespace takt {

/// Bounds what is told: of each kind and node 16 at once, and two a second in the long run.
/// Remembers as many entries as there are kinds times nodes. Front thread.
class NoticeLimit {
 public:
  /// Nothing: not now. Else: tell it; the value is how many were kept back since the last one.
  std::optional<std::uint64_t> allow(const Notice& notice);

 private:
  struct Account {
    Time free_at{};  ///< when all that was told has been paid for
    std::uint64_t kept_back = 0;
  };
  std::map<std::pair<std::string, std::uint8_t>, Account> accounts_;
};

}  // namespace takt
