#include "master/gateway/notice/merged_notices.hpp"

#include <utility>

namespace takt {
namespace {

constexpr std::string_view between = ": ";
constexpr std::size_t longest_subject = 160;

}  // namespace

std::optional<std::string> merged_text(std::string_view first, std::string_view second) {
  const std::size_t at = first.find(between);
  const std::size_t other = second.find(between);
  if (at == first.npos || other == second.npos || at > longest_subject) return std::nullopt;
  if (first.substr(at) != second.substr(other) || first == second) return std::nullopt;
  if (first.find('\n') != first.npos) return std::nullopt;
  return std::string{first.substr(0, at)}
      .append(", ")
      .append(second.substr(0, other))
      .append(first.substr(at));
}

std::optional<Notice> MergedNotices::add(const Notice& notice) {
  const bool close = kept_ && kept_->kind == notice.kind && kept_->weight == notice.weight &&
                     notice.when - kept_->when <= same_cause;
  if (close) {
    if (auto text = merged_text(kept_->text, notice.text)) {
      kept_->text = *std::move(text);
      return std::nullopt;
    }
  }
  return std::exchange(kept_, notice);
}

std::optional<Notice> MergedNotices::take() { return std::exchange(kept_, std::nullopt); }

}  // namespace takt
