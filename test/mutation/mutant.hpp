#pragma once
#include <atomic>
#include <cstdlib>

// Included by the sources of the copy that mutate.py makes, never by the tree itself.

// A mutant may do what warnings forbid, and they are errors.
#pragma GCC diagnostic ignored "-Wpragmas"
#pragma GCC diagnostic ignored "-Waddress"
#pragma GCC diagnostic ignored "-Waggressive-loop-optimizations"
#pragma GCC diagnostic ignored "-Warray-bounds"
#pragma GCC diagnostic ignored "-Wbool-compare"
#pragma GCC diagnostic ignored "-Wbool-operation"
#pragma GCC diagnostic ignored "-Wconversion"
#pragma GCC diagnostic ignored "-Wdangling-pointer"
#pragma GCC diagnostic ignored "-Wdiv-by-zero"
#pragma GCC diagnostic ignored "-Wempty-body"
#pragma GCC diagnostic ignored "-Wenum-compare"
#pragma GCC diagnostic ignored "-Wextra"
#pragma GCC diagnostic ignored "-Wint-in-bool-context"
#pragma GCC diagnostic ignored "-Wlogical-not-parentheses"
#pragma GCC diagnostic ignored "-Wmaybe-uninitialized"
#pragma GCC diagnostic ignored "-Wmisleading-indentation"
#pragma GCC diagnostic ignored "-Wnonnull"
#pragma GCC diagnostic ignored "-Woverflow"
#pragma GCC diagnostic ignored "-Wparentheses"
#pragma GCC diagnostic ignored "-Wpessimizing-move"
#pragma GCC diagnostic ignored "-Wredundant-move"
#pragma GCC diagnostic ignored "-Wreturn-type"
#pragma GCC diagnostic ignored "-Wshadow"
#pragma GCC diagnostic ignored "-Wshift-count-negative"
#pragma GCC diagnostic ignored "-Wshift-count-overflow"
#pragma GCC diagnostic ignored "-Wshift-negative-value"
#pragma GCC diagnostic ignored "-Wsign-compare"
#pragma GCC diagnostic ignored "-Wstringop-overflow"
#pragma GCC diagnostic ignored "-Wstringop-overread"
#pragma GCC diagnostic ignored "-Wtautological-compare"
#pragma GCC diagnostic ignored "-Wtype-limits"
#pragma GCC diagnostic ignored "-Wuninitialized"
#pragma GCC diagnostic ignored "-Wunused"

namespace takt_mutation {

constexpr int most = 4096;
/// The number of the mutant that is selected; 0 selects none. TAKT_MUTANT=-1 selects none and
/// notes which mutants are reached.
inline const int selected = [] {
  const char* const text = std::getenv("TAKT_MUTANT");
  return text == nullptr ? 0 : std::atoi(text);
}();
inline std::atomic<bool> reached[most];

}  // namespace takt_mutation

/// Returns true where the place has to behave as mutant `number`. Constant expressions are never
/// mutated.
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
