#pragma once
#include <atomic>
#include <cstddef>
#include <cstdint>
#include <cstring>
#include <span>
#include <type_traits>
#include <vector>

namespace takt {

/// Bytes that one thread writes and others read without being torn. The writer never waits; a
/// reader retries while it is being overtaken.
class Seqlock {
 public:
  explicit Seqlock(std::size_t bytes) : words_((bytes + 7) / 8) {}

  /// Writer: between begin() and end(), any number of put().
  void begin() noexcept {
    version_.store(version_.load(std::memory_order_relaxed) + 1, std::memory_order_relaxed);
    std::atomic_thread_fence(std::memory_order_release);
  }
  /// `word` counts 8-byte words from the start.
  template <class T>
  void put(std::size_t word, const T& item) noexcept {
    static_assert(std::is_trivially_copyable_v<T>);
    const auto* bytes = reinterpret_cast<const std::byte*>(&item);
    for (std::size_t at = 0; at < sizeof(T); at += 8, ++word) {
      std::uint64_t value = 0;
      std::memcpy(&value, bytes + at, sizeof(T) - at < 8 ? sizeof(T) - at : 8);
      words_[word].store(value, std::memory_order_relaxed);
    }
  }
  void end() noexcept {
    version_.store(version_.load(std::memory_order_relaxed) + 1, std::memory_order_release);
  }

  /// Any thread. Runs `read_all`, which calls get(), until nothing was written meanwhile.
  template <class F>
  void read(F&& read_all) const noexcept {
    for (;;) {
      const std::uint64_t before = version_.load(std::memory_order_acquire);
      if ((before & 1) != 0) continue;
      read_all();
      std::atomic_thread_fence(std::memory_order_acquire);
      if (version_.load(std::memory_order_relaxed) == before) return;
    }
  }
  template <class T>
  void get(std::size_t word, T& item) const noexcept {
    static_assert(std::is_trivially_copyable_v<T>);
    auto* bytes = reinterpret_cast<std::byte*>(&item);
    for (std::size_t at = 0; at < sizeof(T); at += 8, ++word) {
      const std::uint64_t value = words_[word].load(std::memory_order_relaxed);
      std::memcpy(bytes + at, &value, sizeof(T) - at < 8 ? sizeof(T) - at : 8);
    }
  }

 private:
  std::atomic<std::uint64_t> version_{0};
  std::vector<std::atomic<std::uint64_t>> words_;
};

/// 8-byte words that a T takes in a Seqlock.
template <class T>
inline constexpr std::size_t seqlock_words = (sizeof(T) + 7) / 8;

}  // namespace takt
