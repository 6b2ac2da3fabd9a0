#include "master/sim/model/io401.hpp"

namespace takt::sim {
namespace {

constexpr std::uint16_t digital_in = 0x6000;
constexpr std::uint16_t digital_out = 0x6200;
constexpr std::uint16_t digital_error_mode = 0x6206;
constexpr std::uint16_t digital_error_value = 0x6207;
constexpr std::uint16_t analogue_in = 0x6401;
constexpr std::uint16_t analogue_out = 0x6411;
constexpr std::uint16_t analogue_error_mode = 0x6443;
constexpr std::uint16_t analogue_error_value = 0x6444;

constexpr Time shortest_pause = std::chrono::milliseconds{20};
constexpr std::uint32_t pause_spread_us = 180'000;
constexpr std::uint32_t analogue_step = 401;

}  // namespace

Io401::Io401(ObjectStore& store, EmcyProducer& emcy, Random random, bool loopback)
    : Model{emcy}, store_{store}, random_{random}, loopback_{loopback} {
  for (Object& object : store.range(digital_in, digital_in)) {
    if (object.key.sub == 0 || object.is_bytes()) continue;
    digital_.push_back({&object, store.find({digital_out, object.key.sub})});
  }
  for (Object& object : store.range(analogue_in, analogue_in)) {
    if (object.key.sub == 0 || object.is_bytes()) continue;
    analogue_.push_back({&object, store.find({analogue_out, object.key.sub})});
  }
}

void Io401::reset(Time now) noexcept {
  next_change_ = digital_.empty() && analogue_.empty() ? never : now + shortest_pause;
  if (loopback_) repeat_outputs();
}

void Io401::advance(Time now) noexcept {
  while (!loopback_ && now >= next_change_) {
    change_an_input();
    next_change_ += shortest_pause + std::chrono::microseconds{random_.below(pause_spread_us)};
  }
}

void Io401::change_an_input() noexcept {
  if (!digital_.empty()) {
    Object& input = *digital_[random_.below(static_cast<std::uint32_t>(digital_.size()))].input;
    input.set(input.value ^ std::uint64_t{1} << random_.below(input.width * 8u));
  }
  for (const Channel& channel : analogue_) {
    const std::int64_t step = random_.below(2 * analogue_step + 1);
    channel.input->set(static_cast<std::uint64_t>(channel.input->number() + step - analogue_step));
  }
}

void Io401::outputs(Time) noexcept {
  if (loopback_) repeat_outputs();
}

void Io401::repeat_outputs() noexcept {
  for (const auto* channels : {&digital_, &analogue_}) {
    for (const Channel& channel : *channels) {
      if (channel.output != nullptr) channel.input->set(channel.output->value);
    }
  }
}

void Io401::connection_lost(Time) noexcept {
  for (Object& output : store_.range(digital_out, digital_out)) {
    const Object* mode = store_.find({digital_error_mode, output.key.sub});
    const Object* value = store_.find({digital_error_value, output.key.sub});
    if (output.key.sub == 0 || mode == nullptr || value == nullptr) continue;
    output.set((output.value & ~mode->value) | (value->value & mode->value));
  }
  for (Object& output : store_.range(analogue_out, analogue_out)) {
    const Object* value = store_.find({analogue_error_value, output.key.sub});
    const bool changes = store_.number({analogue_error_mode, output.key.sub}) == 1;
    if (output.key.sub != 0 && changes && value != nullptr) output.set(value->value);
  }
}

}  // namespace takt::sim
