#pragma once
#include <array>
#include <cstddef>
#include <span>

#include "eds_parser/table/time.hpp"
#include "master/wire/frame.hpp"

namespace takt::sim {

/// A frame that a device hands to its controller, in the device's own time.
struct Transmission {
  Frame frame{};
  Time ready{};
  Time expires = never;
};

/// What one call of a device wants to send. The world takes it after each call.
class Transmitter {
 public:
  void send(const Frame& frame, Time ready, Time expires = never) noexcept {
    if (size_ < items_.size()) items_[size_++] = {frame, ready, expires};
  }
  std::span<const Transmission> pending() const noexcept { return {items_.data(), size_}; }
  void clear() noexcept { size_ = 0; }
  /// Takes back what was handed over since there were `size`.
  void shrink(std::size_t size) noexcept { size_ = size; }

 private:
  /// 512 PDOs in answer to one SYNC, and what else there may be.
  std::array<Transmission, 576> items_{};
  std::size_t size_ = 0;
};

}  // namespace takt::sim
