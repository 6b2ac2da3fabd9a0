#include "master/gateway/message/image_messages.hpp"

#include <algorithm>
#include <chrono>
#include <utility>

#include "master/gateway/notice/notice.hpp"
#include "master/lcm/messages.hpp"

namespace takt {
namespace {

signal_t to_message(const BusPlan& plan, const Signal& signal) {
  signal_t message{};
  message.node = plan.nodes[signal.node_index].name;
  message.node_id = signal.node.value();
  message.name = signal.name;
  message.index = signal.object.index;
  message.sub = signal.object.sub;
  message.output = signal.output ? 1 : 0;
  message.data_type = static_cast<std::int16_t>(signal.type);
  message.bits = signal.bits;
  message.unit = signal.unit;
  message.scale = signal.scale;
  message.offset = signal.offset;
  return message;
}

layout_t empty_layout(const BusPlan& plan, std::int64_t session, std::size_t first) {
  layout_t message{};
  message.schema = message_schema;
  message.session = session;
  message.hash = static_cast<std::int64_t>(plan.layout.hash);
  message.period_ns = plan.cycle.period.count();
  message.total_signals = static_cast<std::int32_t>(plan.layout.signals.size());
  message.inputs = static_cast<std::int32_t>(plan.layout.inputs);
  message.first_signal = static_cast<std::int32_t>(first);
  return message;
}

}  // namespace

bool is_stale(const ImageView& image, std::size_t signal) noexcept {
  const std::size_t word = signal / 64;
  return word < image.stale_bits.size() && (image.stale_bits[word] >> (signal % 64) & 1) != 0;
}

ImageMessages::ImageMessages(const BusPlan& plan, std::int64_t session) {
  const std::size_t signals = plan.layout.signals.size();
  const std::size_t parts =
      std::max<std::size_t>(1, (signals + values_a_message - 1) / values_a_message);
  for (std::size_t part = 0; part < parts; ++part) {
    image_t message{};
    const std::size_t first = part * values_a_message;
    const std::size_t count = std::min(values_a_message, signals - first);
    message.schema = message_schema;
    message.part = static_cast<std::int16_t>(part);
    message.parts = static_cast<std::int16_t>(parts);
    message.session = session;
    message.layout_hash = static_cast<std::int64_t>(plan.layout.hash);
    message.first_signal = static_cast<std::int32_t>(first);
    message.num_values = static_cast<std::int32_t>(count);
    message.values.resize(count);
    message.stale.reserve(count);
    parts_.push_back(std::move(message));
  }
}

const std::vector<image_t>& ImageMessages::fill(const ImageView& image, Time wall_minus_monotonic) {
  for (image_t& message : parts_) {
    const auto first = static_cast<std::size_t>(message.first_signal);
    message.utime = (image.sync_time + wall_minus_monotonic) / std::chrono::microseconds{1};
    message.sync_mono_ns = image.sync_time.count();
    message.cycle = static_cast<std::int64_t>(image.cycle);
    message.stale.clear();
    for (std::size_t i = 0; i < message.values.size(); ++i) {
      message.values[i] = image.values[first + i];
      if (is_stale(image, first + i)) {
        message.stale.push_back(static_cast<std::int32_t>(first + i));
      }
    }
    message.num_stale = static_cast<std::int32_t>(message.stale.size());
  }
  return parts_;
}

std::vector<layout_t> layout_messages(const BusPlan& plan, std::int64_t session) {
  std::vector<layout_t> messages{empty_layout(plan, session, 0)};
  for (std::size_t i = 0; i < plan.layout.signals.size(); ++i) {
    signal_t signal = to_message(plan, plan.layout.signals[i]);
    const int size = messages.back().getEncodedSize() + signal._getEncodedSizeNoHash();
    if (messages.back().num_signals > 0 && static_cast<std::size_t>(size) > message_bytes) {
      messages.push_back(empty_layout(plan, session, i));
    }
    messages.back().signals.push_back(std::move(signal));
    ++messages.back().num_signals;
  }
  number_parts(messages);
  return messages;
}

}  // namespace takt
