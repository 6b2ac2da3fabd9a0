#pragma once
#include <atomic>
#include <cstdlib>

// Included by the sources of the copy that mutate.py makes, never by the tree itself.

namespace takt_mutation {

constexpr int most = 100'000;
/// The number of the mutant that is selected; 0 selects none. TAKT_MUTANT=-1 selects none and
/// notes which mutants are reached.
inline const int selected = [] {
  const char* const text = std::getenv("TAKT_MUTANT");
  return text == nullptr ? 0 : std::atoi(text);
}();
inline std::atomic<bool> reached[most];

}  // namespace takt_mutation

/// Returns true if the code at this place has to behave as mutant `number`. Constant expressions
/// are never mutated.
constexpr bool takt_mutant(int number) noexcept {
  if consteval {
    return false;
  } else {
    if (takt_mutation::selected == number) return true;
    if (takt_mutation::selected < 0) {
      takt_mutation::reached[number].store(true, std::memory_order_relaxed);
    }
    return false;
  }
}
