#pragma once
#include <cstddef>
#include <cstdint>
#include <deque>
#include <vector>

namespace takt {

/// Keeps the newest error codes of each node, newest first. Front thread.
class EmcyHistory {
 public:
  static constexpr std::size_t kept = 10;  ///< error codes per node

  explicit EmcyHistory(std::size_t nodes) : codes_(nodes) {}

  void add(std::size_t node_index, std::uint16_t code) {
    if (node_index >= codes_.size()) return;
    codes_[node_index].push_front(code);
    if (codes_[node_index].size() > kept) codes_[node_index].pop_back();
  }
  const std::deque<std::uint16_t>& of(std::size_t node_index) const { return codes_[node_index]; }
  std::size_t nodes() const noexcept { return codes_.size(); }

 private:
  std::vector<std::deque<std::uint16_t>> codes_;
};

}  // namespace takt
