#include "master/gateway/notice/notice_limit.hpp"

#include <algorithm>
#include <chrono>

namespace takt {
namespace {

constexpr Time price = std::chrono::milliseconds{500};
constexpr Time longest_debt = 15 * price;

}  // namespace

std::optional<std::uint64_t> NoticeLimit::allow(const Notice& notice) {
  Account& account = accounts_[{notice.kind, notice.node}];
  if (account.free_at > notice.when + longest_debt) {
    ++account.kept_back;
    return std::nullopt;
  }
  account.free_at = std::max(account.free_at, notice.when) + price;
  return std::exchange(account.kept_back, 0);
}

}  // namespace takt
