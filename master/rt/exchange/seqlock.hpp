#pragma once
#include <array>
#include <atomic>
#include <cstddef>
#include <cstdint>
#include <cstring>
#include <type_traits>
#include <vector>

namespace takt {

/// Holds bytes that one thread writes and other threads read without tearing. The writer never
/// waits; a reader reads again if a write happened meanwhile.
class Seqlock {
 public:
  explicit Seqlock(std::size_t bytes) : words_((bytes + 7) / 8) {}

  /// Writer: begin(), then any number of put(), then end().
  void begin() noexcept {
    version_.store(version_.load(std::memory_order_relaxed) + 1, std::memory_order_relaxed);
    std::atomic_thread_fence(std::memory_order_release);
  }
  /// `word` counts 8-byte words from the start.
  template <class T>
  void put(std::size_t word, const T& item) noexcept {
    static_assert(std::is_trivially_copyable_v<T>);
    std::array<std::uint64_t, (sizeof(T) + 7) / 8> raw{};
    std::memcpy(raw.data(), &item, sizeof(T));
    std::atomic<std::uint64_t>* const to = words_.data() + word;
    for (std::size_t i = 0; i < raw.size(); ++i) to[i].store(raw[i], std::memory_order_relaxed);
  }
  void end() noexcept {
    version_.store(version_.load(std::memory_order_relaxed) + 1, std::memory_order_release);
  }

  /// Any thread. The number changes with each write. Bytes that are read afterwards are not older
  /// than the number.
  std::uint64_t version() const noexcept { return version_.load(std::memory_order_acquire); }
  /// Any thread. Repeats `read_all`, which calls get(), until no write happened meanwhile.
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
    std::array<std::uint64_t, (sizeof(T) + 7) / 8> raw;
    for (std::size_t i = 0; i < raw.size(); ++i) {
      raw[i] = words_[word + i].load(std::memory_order_relaxed);
    }
    std::memcpy(static_cast<void*>(&item), raw.data(), sizeof(T));
  }

 private:
  std::atomic<std::uint64_t> version_{0};
  std::vector<std::atomic<std::uint64_t>> words_;
};

/// 8-byte words that a T takes in a Seqlock.
template <class T>
inline constexpr std::size_t seqlock_words = (sizeof(T) + 7) / 8;

}  // namespace takt
