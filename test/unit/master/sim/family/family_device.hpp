#pragma once
#include <array>
#include <memory>
#include <string>
#include <utility>
#include <vector>

#include "eds_parser/plan/device/device_compiler.hpp"
#include "eds_parser/read/eds.hpp"
#include "master/sim/device/device.hpp"

namespace takt::sim {

struct Variant {
  std::string firmware{};
  std::vector<std::string> quirks{};
};

/// Node 5 of a device family, built from its EDS and stepped by hand. Times are in ms after
/// start().
class FamilyDevice {
 public:
  FamilyDevice(const std::string& eds, const std::string& model, const Variant& variant = {})
      : device_{std::make_unique<Device>(table(eds, model, variant), Random{1},
                                         DeviceTimes{.pdo = Time{}})} {
    device_->power_on(Time{});
    run(std::chrono::milliseconds{100});
  }

  Device& device() { return *device_; }

  /// Makes an expedited download while the device is PRE-OPERATIONAL and returns its abort code; 0
  /// means success.
  std::uint32_t write(ObjectKey key, std::uint32_t value, unsigned bytes) {
    Frame request{.id = CobId::base(0x605), .length = 8};
    request.data = {static_cast<std::uint8_t>(0x23 | (4 - bytes) << 2),
                    static_cast<std::uint8_t>(key.index & 0xFF),
                    static_cast<std::uint8_t>(key.index >> 8),
                    key.sub,
                    static_cast<std::uint8_t>(value & 0xFF),
                    static_cast<std::uint8_t>(value >> 8 & 0xFF),
                    static_cast<std::uint8_t>(value >> 16 & 0xFF),
                    static_cast<std::uint8_t>(value >> 24)};
    return transfer(request);
  }
  /// Makes an upload and returns its abort code; 0 means success.
  std::uint32_t read(ObjectKey key) {
    return transfer(make_frame(CobId::base(0x605),
                               {0x40, static_cast<std::uint8_t>(key.index & 0xFF),
                                static_cast<std::uint8_t>(key.index >> 8), key.sub, 0, 0, 0, 0}));
  }

  void start() {
    frames_.clear();
    t0_ = now_;
    receive(make_frame(CobId::base(0), {1, 5}));
  }
  /// Lets time pass until `ms` after start().
  void at(int ms) { run(t0_ + std::chrono::milliseconds{ms}); }
  void receive(const Frame& frame) {
    device_->on_frame(frame, now_);
    collect();
  }
  void fail(std::uint16_t emcy_code) {
    device_->fail(emcy_code, now_);
    collect();
  }
  /// Returns the value of an object of 16 bits, with its sign.
  int word(ObjectKey key) { return static_cast<std::int16_t>(device_->objects().find(key)->value); }
  void sync() { receive(Frame{.id = CobId::base(0x080)}); }
  void request(std::uint32_t id) {
    Frame frame{.id = CobId::base(id)};
    frame.rtr = true;
    receive(frame);
  }
  /// Sends four little-endian words as an RPDO.
  void words(std::uint32_t id, std::array<std::uint16_t, 4> values) {
    Frame frame{.id = CobId::base(id), .length = 8};
    for (std::size_t i = 0; i < 8; ++i) {
      frame.data[i] = static_cast<std::uint8_t>(values[i / 2] >> (i % 2 * 8) & 0xFF);
    }
    receive(frame);
  }

  /// Returns the times of frames with this identifier in ms after start().
  std::vector<int> times(std::uint32_t id) const {
    std::vector<int> found;
    for (const auto& [when, frame] : frames_) {
      if (frame.id != CobId::base(id)) continue;
      found.push_back(static_cast<int>((when - t0_) / std::chrono::milliseconds{1}));
    }
    return found;
  }
  std::vector<Frame> of(std::uint32_t id) const {
    std::vector<Frame> found;
    for (const auto& [when, frame] : frames_) {
      if (frame.id == CobId::base(id)) found.push_back(frame);
    }
    return found;
  }
  void clear() { frames_.clear(); }

 private:
  static DeviceTable table(const std::string& eds, const std::string& model,
                           const Variant& variant) {
    const NodeId id = *NodeId::from(5);
    const EdsFile file = read_eds_file(TAKT_SOURCE_DIR "/share/eds/" + eds, id);
    NodeSpec spec;
    spec.sim.model = model;
    spec.sim.quirks = variant.quirks;
    DeviceTable out = compile_device({&spec, &file.dictionary, id});
    out.firmware = variant.firmware;
    return out;
  }

  void run(Time end) {
    while (device_->deadline() <= end) {
      now_ = std::max(now_, device_->deadline());
      device_->on_time(now_);
      collect();
    }
    now_ = end;
  }
  void collect() {
    for (const Transmission& item : device_->out().pending()) {
      frames_.emplace_back(item.ready, item.frame);
    }
    device_->out().clear();
  }
  std::uint32_t transfer(const Frame& request) {
    frames_.clear();
    receive(request);
    run(now_ + std::chrono::milliseconds{1});
    const std::vector<Frame> answers = of(0x585);
    if (answers.size() != 1) return 1;
    const auto& data = answers[0].data;
    if (data[0] != 0x80) return 0;
    return data[4] | std::uint32_t{data[5]} << 8 | std::uint32_t{data[6]} << 16 |
           std::uint32_t{data[7]} << 24;
  }

  std::unique_ptr<Device> device_;
  Time now_{};
  Time t0_{};
  std::vector<std::pair<Time, Frame>> frames_;
};

}  // namespace takt::sim
