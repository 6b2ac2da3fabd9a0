#pragma once
#include <array>
#include <cstddef>
#include <span>

#include "eds_parser/values/time.hpp"
#include "master/wire/frame.hpp"

namespace takt::sim {

/// A frame that a device hands to its CAN controller. Times are local times of the device.
struct Transmission {
  Frame frame{};
  Time ready{};
  Time expires = never;
};

/// The frames that a device wants to send after one call. The world takes them after each call.
class Transmitter {
 public:
  void send(const Frame& frame, Time ready, Time expires = never) noexcept {
    if (size_ < items_.size()) items_[size_++] = {frame, ready, expires};
  }
  std::span<const Transmission> pending() const noexcept { return {items_.data(), size_}; }
  void clear() noexcept { size_ = 0; }
  /// Removes all frames behind the first `size`.
  void shrink(std::size_t size) noexcept { size_ = size; }

 private:
  std::size_t size_ = 0;
  /// Room for 512 PDOs in answer to one SYNC, and for other frames.
  std::array<Transmission, 576> items_{};
};

}  // namespace takt::sim
