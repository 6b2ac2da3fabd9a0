#pragma once
#include <algorithm>
#include <array>
#include <bit>
#include <bitset>
#include <cmath>
#include <concepts>
#include <cstddef>
#include <cstdint>
#include <optional>
#include <span>
#include <type_traits>
#include <vector>

#include "eds_parser/values/ids.hpp"
#include "eds_parser/values/time.hpp"

namespace takt {

/// Saves or restores the state of a machine as a sequence of words, so that another machine with
/// the same plan can continue from it. Each machine lists its values in `keep(state)`. The list
/// has neither values that follow from the plan nor values that are needed only during a transfer
/// or a request. The derived class `Words` provides the words.
template <class Words>
class KeptState {
 public:
  template <class... T>
  /// Saves or restores the values, in this order.
  void operator()(T&... values) noexcept {
    (one(values), ...);
  }
  /// Saves or restores a position that must be below `end`. A restored value that is not below
  /// `end` becomes 0.
  template <std::unsigned_integral T>
  void position(T& value, std::size_t end) noexcept {
    one(value);
    if (value >= end) put(value, T{0});
  }
  /// Saves or restores a time span that is used as a divisor or is added in each cycle. The
  /// restored value is always positive.
  void period(Time& value) noexcept {
    one(value);
    put(value, std::clamp(value, Time{1}, longest_period));
  }

 private:
  /// The largest absolute value of a time in nanoseconds. Sums of such times do not overflow.
  static constexpr std::int64_t longest = std::int64_t{1} << 56;
  /// The longest period. It is 73 min, which is longer than any period that 0x1006 can state.
  static constexpr Time longest_period{std::int64_t{1} << 42};
  /// Largest absolute value of a signed count.
  static constexpr std::int64_t largest = 1 << 30;

  std::uint64_t word(std::uint64_t value) noexcept {
    return static_cast<Words&>(*this).next(value);
  }

  /// Sets a value. Only StateReader changes the machine; StateSize and StateWriter leave it as it
  /// is.
  template <class T>
  static void put(T& value, T read) noexcept {
    if constexpr (Words::restores) value = read;
  }

  void one(bool& value) noexcept { put(value, word(value ? 1 : 0) != 0); }
  void one(std::int64_t& value) noexcept {
    put(value, static_cast<std::int64_t>(word(static_cast<std::uint64_t>(value))));
  }
  void one(int& value) noexcept {
    std::int64_t wide = value;
    one(wide);
    put(value, static_cast<int>(std::clamp(wide, -largest, largest)));
  }
  template <std::unsigned_integral T>
  void one(T& value) noexcept {
    put(value, static_cast<T>(word(value)));
  }
  template <class E>
    requires std::is_enum_v<E>
  void one(E& value) noexcept {
    put(value, static_cast<E>(word(static_cast<std::uint64_t>(value))));
  }
  void one(char& value) noexcept {
    put(value, static_cast<char>(word(static_cast<unsigned char>(value))));
  }
  void one(Time& value) noexcept {
    std::int64_t count = value.count();
    one(count);
    // Even if the checkpoint is damaged, each time except `never` can be subtracted from any other.
    put(value, count == never.count() ? never : Time{std::clamp(count, -longest, longest)});
  }
  /// Saves or restores a real number. NaN is restored as 0. Infinity is permitted, because it means
  /// that there is no limit.
  void one(double& value) noexcept {
    const auto read = std::bit_cast<double>(word(std::bit_cast<std::uint64_t>(value)));
    put(value, std::isnan(read) ? 0.0 : read);
  }
  void one(ObjectKey& value) noexcept { (*this)(value.index, value.sub); }
  template <class T>
  void one(std::optional<T>& value) noexcept {
    bool there = value.has_value();
    one(there);
    T content = value.value_or(T{});
    one(content);
    put(value, there ? std::optional{content} : std::nullopt);
  }
  template <class T, std::size_t N>
  void one(std::array<T, N>& values) noexcept {
    for (T& value : values) one(value);
  }
  template <class T>
  void one(std::vector<T>& values) noexcept {
    for (T& value : values) one(value);
  }
  template <std::size_t N>
  void one(std::bitset<N>& values) noexcept {
    for (std::size_t i = 0; i < N; ++i) {
      bool value = values[i];
      one(value);
      if constexpr (Words::restores) values[i] = value;
    }
  }
  template <class T>
    requires requires(T& machine, Words& state) { machine.keep(state); }
  void one(T& machine) noexcept {
    machine.keep(static_cast<Words&>(*this));
  }
};

/// Counts the words that the state of a machine needs.
class StateSize : public KeptState<StateSize> {
 public:
  static constexpr bool restores = false;

  std::uint64_t next(std::uint64_t value) noexcept {
    ++count_;
    return value;
  }
  std::size_t count() const noexcept { return count_; }

 private:
  std::size_t count_ = 0;
};

/// Writes the words to memory that has room for all of them.
class StateWriter : public KeptState<StateWriter> {
 public:
  static constexpr bool restores = false;

  explicit StateWriter(std::uint64_t* to) noexcept : to_{to} {}
  std::uint64_t next(std::uint64_t value) noexcept { return *to_++ = value; }

 private:
  std::uint64_t* to_;
};

/// Restores the state from words. Any content of the words is safe. If there are too few words, the
/// remaining values stay as they were.
class StateReader : public KeptState<StateReader> {
 public:
  static constexpr bool restores = true;

  explicit StateReader(std::span<const std::uint64_t> words) noexcept : words_{words} {}
  std::uint64_t next(std::uint64_t value) noexcept {
    if (words_.empty()) return value;
    value = words_.front();
    words_ = words_.subspan(1);
    return value;
  }

 private:
  std::span<const std::uint64_t> words_;
};

}  // namespace takt
