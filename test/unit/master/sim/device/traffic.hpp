#pragma once
#include <algorithm>
#include <chrono>
#include <cstdint>
#include <vector>

#include "master/sim/device/device.hpp"
#include "test/unit/master/sim/device/sample_device.hpp"

namespace takt::sim {

using namespace std::chrono_literals;

/// One device that is stepped by hand. Frames come out with the time at which they are ready.
class Traffic {
 public:
  explicit Traffic(SampleDevice device) : device_{device.build(), Random{1}, {.pdo = 0ns}} {
    device_.power_on(0ns);
    run(100ms);
    clear();
  }

  Device& operator*() { return device_; }
  Device* operator->() { return &device_; }
  void run(Time end) {
    while (device_.deadline() <= end) {
      now_ = std::max(now_ + Time{1}, device_.deadline());
      device_.on_time(now_);
      collect();
    }
    now_ = end;
  }
  void receive(const Frame& frame) {
    device_.on_frame(frame, now_);
    collect();
  }
  void start() { receive(make_frame(CobId::base(0), {1, 5})); }
  void sync(std::uint8_t counter = 0) {
    run(now_ + 1ms);
    Frame frame{.id = CobId::base(0x080)};
    if (counter != 0) frame = make_frame(CobId::base(0x080), {counter});
    receive(frame);
  }
  void set(std::uint16_t index, std::uint64_t value) {
    device_.objects().find({index, 0})->set(value);
  }
  std::uint64_t get(std::uint16_t index) { return device_.objects().find({index, 0})->value; }
  void clear() { frames_.clear(); }
  /// Returns the frames with this identifier since clear().
  std::vector<Transmission> of(std::uint32_t id) const {
    std::vector<Transmission> found;
    for (const Transmission& item : frames_) {
      if (item.frame.id == CobId::base(id)) found.push_back(item);
    }
    return found;
  }
  Time now() const { return now_; }

 private:
  void collect() {
    for (const Transmission& item : device_.out().pending()) frames_.push_back(item);
    device_.out().clear();
  }

  Device device_;
  Time now_{};
  std::vector<Transmission> frames_;
};

inline SampleDevice with_tpdo(std::uint8_t type) {
  return communicating(5_node).pdo(0x1800, 0x185, type, {0x20110020});
}
inline SampleDevice with_rpdo(std::uint8_t type) {
  return communicating(5_node).pdo(0x1400, 0x205, type, {0x20100020, 0x20120010});
}

}  // namespace takt::sim
