#pragma once
// A simulated device of the PDO matrix that is stepped through the events of a row.
#include <algorithm>
#include <map>
#include <utility>
#include <vector>

#include "master/sim/device/device.hpp"
#include "test/virtual/pdo_matrix_preset.hpp"
#include "test/virtual/pdo_matrix_table.hpp"

namespace takt::test {

using namespace std::chrono_literals;

constexpr Time started = 200ms;  ///< NMT start of the device

/// Adds the second pair of PDOs. The first pair cannot be used because it is the parameter channel
/// of a DRV-28.
inline sim::SampleDevice with_pdos(std::uint8_t type, std::uint32_t cob = 0x285) {
  return sim::communicating(5_node)
      .pdo(0x1401, 0x305, 255, {0x2010'0020})
      .pdo(0x1801, cob, type, {0x2011'0020});
}

/// Makes the request of an expedited download to node 5.
inline Frame download(ObjectKey key, std::uint32_t value, unsigned bytes) {
  const auto byte = [](std::uint32_t bits) { return static_cast<std::uint8_t>(bits & 0xFF); };
  return make_frame(CobId::base(0x605), {byte(0x23u | (4 - bytes) << 2), byte(key.index),
                                         byte(std::uint32_t{key.index} >> 8), key.sub, byte(value),
                                         byte(value >> 8), byte(value >> 16), byte(value >> 24)});
}

inline int ms_after_start(Time when) { return static_cast<int>((when - started + 500us) / 1ms); }

/// Steps a device through the events of a row and records its frames with their times.
class Stepper {
 public:
  explicit Stepper(DeviceTable table)
      : table_{std::move(table)}, device_{table_, sim::Random{1}, {.pdo = 0ns}} {
    device_.power_on(0ns);
    run_to(started - 1ms);
  }

  void start() {
    run_to(started);
    receive(make_frame(CobId::base(0), {1, 5}));
  }
  void run_to(Time end) {
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
  /// Changes the value by SDO, so that the device notices the change at once.
  void change(std::uint8_t value) { receive(download({0x2011, 0}, value, 4)); }
  std::uint64_t value(ObjectKey key) { return device_.objects().find(key)->value; }
  /// Returns the times of frames with this identifier in ms after the start.
  std::vector<int> frames(std::uint32_t id = 0x285) const {
    std::vector<int> times;
    for (const sim::Transmission& item : sent_) {
      if (item.frame.id == CobId::base(id)) times.push_back(ms_after_start(item.ready));
    }
    return times;
  }

 private:
  void collect() {
    const auto pending = device_.out().pending();
    sent_.insert(sent_.end(), pending.begin(), pending.end());
    device_.out().clear();
  }

  DeviceTable table_;
  sim::Device device_;
  std::vector<sim::Transmission> sent_;
  Time now_{};
};

/// The events at one moment, in this order.
struct Moment {
  bool change = false, back = false, sync = false, remote = false, rpdo = false;
};

inline std::map<int, Moment> moments_of(const Course& course) {
  std::map<int, Moment> moments;
  for (const int ms : course.changes) moments[ms].change = true;
  for (const int ms : course.back) moments[ms].back = true;
  for (const int ms : course.syncs) moments[ms].sync = true;
  for (const int ms : course.remote) moments[ms].remote = true;
  for (const int ms : course.rpdos) moments[ms].rpdo = true;
  return moments;
}

inline DeviceTable device_of(const Reading& reading, const TpdoRow& row) {
  sim::SampleDevice sample = with_pdos(row.type, row.course.no_rtr ? 0x4000'0285 : 0x285);
  sample.model(reading.model);
  if (*reading.quirk != 0) sample.quirk(reading.quirk);
  DeviceTable table = sample.build();
  preset(table, {0x1801, 3}, row.course.inhibit);
  preset(table, {0x1801, 5}, row.course.timer);
  return table;
}

/// Steps the device through a course until `until` ms after the start.
inline void follow(Stepper& device, const Course& course, int until) {
  std::uint8_t value = 0;
  for (const auto& [ms, moment] : moments_of(course)) {
    device.run_to(started + 1ms * ms);
    if (moment.change) device.change(++value);
    if (moment.back) device.change(0);
    if (moment.sync) device.receive({.id = CobId::base(0x080)});
    if (moment.remote) device.receive({.id = CobId::base(0x285), .length = 4, .rtr = true});
    if (moment.rpdo) device.receive(make_frame(CobId::base(0x305), {1, 2, 3, 4}));
  }
  device.run_to(started + 1ms * until);
}

/// Returns the times at which the TPDO of a row is sent, in ms after the start.
inline std::vector<int> frames_of(const Reading& reading, const TpdoRow& row, int until) {
  Stepper device{device_of(reading, row)};
  device.start();
  follow(device, row.course, until);
  return device.frames();
}

}  // namespace takt::test
