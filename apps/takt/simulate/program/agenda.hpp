#pragma once
#include <algorithm>
#include <cstddef>
#include <functional>
#include <utility>
#include <vector>

#include "eds_parser/values/time.hpp"

namespace takt {

/// A list of actions that are due at later times.
class Agenda {
 public:
  void add(Time when, std::function<void()> what) { items_.push_back({when, std::move(what)}); }
  /// Returns the time of the earliest action; `never` if the agenda is empty.
  Time next() const noexcept {
    Time first = never;
    for (const Item& item : items_) first = std::min(first, item.when);
    return first;
  }
  /// Performs all actions that are due. An action may add further ones.
  void act(Time now) {
    for (std::size_t i = 0; i < items_.size();) {
      if (items_[i].when > now) {
        ++i;
        continue;
      }
      const auto what = std::move(items_[i].what);
      items_.erase(items_.begin() + static_cast<std::ptrdiff_t>(i));
      what();
    }
  }

 private:
  struct Item {
    Time when{};
    std::function<void()> what;
  };
  std::vector<Item> items_;
};

}  // namespace takt
