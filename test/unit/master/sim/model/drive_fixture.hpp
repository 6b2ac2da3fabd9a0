#pragma once
#include <gtest/gtest.h>
#include <initializer_list>

#include "master/sim/dictionary/object_store.hpp"
#include "master/sim/model/drive402.hpp"
#include "master/sim/service/emcy_producer.hpp"
#include "test/unit/master/sim/model/sample_drive.hpp"

namespace takt::sim {

using namespace std::chrono_literals;

class Drive : public testing::Test {
 protected:
  explicit Drive(SampleDevice device = drive(5_node), const MechanicsTable* mechanics = nullptr)
      : store_{device.build()}, emcy_{store_, 5_node}, drive_{store_, emcy_, Random{7}, mechanics} {
    drive_.reset(0ns);
    run(20ms);
  }

  void set(std::uint16_t index, std::int64_t value, std::uint8_t sub = 0) {
    store_.find({index, sub})->set(static_cast<std::uint64_t>(value));
  }
  std::int64_t get(std::uint16_t index) { return store_.number({index, 0}); }
  void command(std::uint16_t word) {
    set(0x6040, word);
    drive_.outputs(now_);
  }
  void run(Time span) {
    for (const Time end = now_ + span; now_ < end;) {
      now_ += 1ms;
      drive_.advance(now_);
    }
  }
  void sync(std::int64_t target) {
    now_ += 2ms;
    drive_.advance(now_);
    set(0x607A, target);
    drive_.outputs(now_);
    drive_.on_sync(now_);
  }
  void enable(int mode) {
    set(0x6060, mode);
    for (const std::uint16_t word : std::initializer_list<std::uint16_t>{0x06, 0x07, 0x0F}) {
      command(word);
      run(1ms);
    }
  }
  /// Returns the statusword without the bits of the mode.
  std::int64_t state() { return get(0x6041) & 0x27F; }

  ObjectStore store_;
  EmcyProducer emcy_;
  Drive402 drive_;
  Time now_{};
};

}  // namespace takt::sim
