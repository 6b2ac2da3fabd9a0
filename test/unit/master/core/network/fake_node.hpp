#pragma once
#include <algorithm>
#include <cstdint>
#include <functional>
#include <map>
#include <optional>
#include <vector>

#include "master/core/machine.hpp"
#include "test/unit/master/core/script.hpp"

namespace takt {

/// A device for tests of the master with an SDO server on a map, NMT, boot-up and heartbeat, and
/// ways to misbehave. The frames are built from literals, not with the codecs of the master.
struct FakeNode {
  using Bytes = std::vector<std::byte>;
  struct Sent {
    Time when;
    Frame frame;
  };

  explicit FakeNode(std::uint8_t node_id) : id{node_id} {}

  std::uint8_t id;
  std::map<ObjectKey, Bytes> objects;
  std::map<ObjectKey, std::uint32_t> read_aborts;
  std::map<ObjectKey, std::uint32_t> write_aborts;
  bool on = true;
  bool mute_sdo = false;
  bool says_bootup = true;
  bool starts = true;  // obeys NMT start
  int swallow = 0;     // requests that get no answer
  Time latency = 1ms;
  Time bootup_delay = 20ms;
  Time heartbeat_period{};
  std::uint8_t state = 0x7F;

  std::function<void(Frame&)> tamper;       // changes SDO answers
  std::function<bool(const Frame&)> loses;  // SDO answers that do not reach the bus
  bool answers_in_turn = false;             // answers one request after another, `latency` each
  Time busy_until{};

  std::vector<ObjectKey> writes;
  int resets = 0;
  std::vector<Sent> sending;  // frames to send later
  Time next_heartbeat = never;

  static Bytes u(std::uint32_t value, std::size_t size) {
    Bytes out;
    for (std::size_t i = 0; i < size; ++i) out.push_back(static_cast<std::byte>(value >> (8 * i)));
    return out;
  }
  void say(Time when, std::uint32_t base, std::initializer_list<std::uint8_t> data) {
    sending.push_back({when, make_frame(CobId::base(base + id), data)});
  }
  void heartbeats(Time now, Time period) {
    heartbeat_period = period;
    next_heartbeat = now + period;
  }

  void on_frame(const Frame& frame, Time now) {
    if (!on) return;
    if (frame.id.id() == 0 && (frame.data[1] == 0 || frame.data[1] == id))
      return on_nmt(frame, now);
    if (frame.id.id() == 0x600U + id && state != 4) on_sdo(frame, now);
  }
  void on_nmt(const Frame& frame, Time now) {
    switch (frame.data[0]) {
      case 1:
        if (starts) state = 5;
        break;
      case 2:
        state = 4;
        break;
      case 128:
        state = 0x7F;
        break;
      default:
        restart(now);
    }
  }
  void restart(Time now) {
    ++resets;
    sending.clear();
    state = 0x7F;
    if (says_bootup) say(now + bootup_delay, 0x700, {0x00});
    if (heartbeat_period > Time{}) next_heartbeat = now + bootup_delay + heartbeat_period;
  }

  void answer(Time now, Frame frame) {
    if (swallow > 0) {
      --swallow;
      return;
    }
    frame.id = CobId::base(0x580U + id);
    if (tamper) tamper(frame);
    if (loses && loses(frame)) return;
    busy_until = (answers_in_turn ? std::max(busy_until, now) : now) + latency;
    if (!mute_sdo) sending.push_back({busy_until, frame});
  }
  void on_sdo(const Frame& frame, Time now) {
    const auto& d = frame.data;
    const ObjectKey key{static_cast<std::uint16_t>(d[1] | d[2] << 8), d[3]};
    const auto abort = [&](std::uint32_t code) {
      answer(now, rx({0x80, d[1], d[2], d[3], static_cast<std::uint8_t>(code),
                      static_cast<std::uint8_t>(code >> 8), static_cast<std::uint8_t>(code >> 16),
                      static_cast<std::uint8_t>(code >> 24)}));
    };
    if (d[0] == 0x80) return;
    if (d[0] == 0x40) {
      if (read_aborts.contains(key)) return abort(read_aborts[key]);
      if (!objects.contains(key)) return abort(0x06020000);
      Frame out = rx({0, d[1], d[2], d[3]});
      const Bytes& value = objects[key];
      if (value.size() > 4) {
        upload = value;
        out.data[0] = 0x41;
        out.data[4] = static_cast<std::uint8_t>(value.size());
      } else {
        out.data[0] = static_cast<std::uint8_t>(0x43 | (4 - value.size()) << 2);
        for (std::size_t i = 0; i < value.size(); ++i) out.data[4 + i] = std::uint8_t(value[i]);
      }
      return answer(now, out);
    }
    if (d[0] == 0x60 || d[0] == 0x70) return next_segment(now, d[0] == 0x70);
    if ((d[0] & 0xE3) == 0x21) return answer(now, rx({0x60, d[1], d[2], d[3]}));
    if ((d[0] & 0xE0) == 0x00) {
      return answer(now, rx({static_cast<std::uint8_t>(0x20 | (d[0] & 0x10))}));
    }
    if ((d[0] & 0xE3) == 0x23) {
      writes.push_back(key);
      if (write_aborts.contains(key)) return abort(write_aborts[key]);
      const std::size_t size = 4U - (d[0] >> 2 & 3U);
      objects[key].clear();
      for (std::size_t i = 0; i < size; ++i) objects[key].push_back(std::byte{d[4 + i]});
      return answer(now, rx({0x60, d[1], d[2], d[3]}));
    }
    abort(0x05040001);
  }
  void next_segment(Time now, bool toggle) {
    const std::size_t size = std::min<std::size_t>(upload.size(), 7);
    Frame out = rx({static_cast<std::uint8_t>((toggle ? 0x10 : 0) | (7 - size) << 1 |
                                              (upload.size() <= 7 ? 1 : 0))});
    for (std::size_t i = 0; i < size; ++i) out.data[1 + i] = std::uint8_t(upload[i]);
    upload.erase(upload.begin(), upload.begin() + std::ptrdiff_t(size));
    answer(now, out);
  }

  Time deadline() const {
    Time first = on ? next_heartbeat : never;
    for (const auto& sent : sending) first = std::min(first, sent.when);
    return first;
  }
  /// Removes and returns the frames that are due.
  std::vector<Frame> take(Time now) {
    std::vector<Frame> due;
    for (auto it = sending.begin(); it != sending.end();) {
      if (it->when > now) {
        ++it;
        continue;
      }
      if (on) due.push_back(it->frame);
      it = sending.erase(it);
    }
    if (on && now >= next_heartbeat) {
      due.push_back(make_frame(CobId::base(0x700U + id), {state}));
      next_heartbeat = now + heartbeat_period;
    }
    return due;
  }

  Bytes upload;
};

}  // namespace takt
