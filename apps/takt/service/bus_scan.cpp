#include "apps/takt/service/bus_scan.hpp"

#include <algorithm>

#include "master/wire/bytes.hpp"
#include "master/wire/heartbeat.hpp"

namespace takt {
namespace {

constexpr std::array<ObjectKey, 6> identity_objects{
    {{0x1000, 0}, {0x1018, 1}, {0x1018, 2}, {0x1018, 3}, {0x1018, 4}, {0x1008, 0}}};
constexpr std::size_t name_step = 5;

std::string text(std::span<const std::byte> bytes) {
  std::string value;
  for (const std::byte byte : bytes) value += static_cast<char>(byte);
  return value.substr(0, value.find('\0'));
}

}  // namespace

BusScan::BusScan(Time timeout, std::size_t most_at_once)
    : timeout_{timeout}, most_at_once_{most_at_once} {}

void BusScan::on_frame(const Frame& frame, Time now) {
  if (const auto heartbeat = decode_heartbeat(frame)) {
    nodes_[heartbeat->node.value()].state = heartbeat->state;
  }
  if (frame.rtr || frame.id.is_extended()) return;
  const std::uint32_t id = frame.id.id();
  if (id > 0x600 && id < 0x680) met_another_client_ = true;  // own frames are not received
  for (const auto& dialogue : running_) {
    if (frame.id == dialogue->client.channel().answer) dialogue->client.on_frame(frame, now);
  }
}

void BusScan::on_time(Time now, Outbox& out) {
  while (running_.size() < most_at_once_ && next_ <= last_node) {
    running_.push_back(std::make_unique<Dialogue>(*NodeId::from(next_++)));
  }
  for (const auto& dialogue : running_) go_on(*dialogue, now, out);
  std::erase_if(running_, [](const std::unique_ptr<Dialogue>& dialogue) {
    return dialogue->step == identity_objects.size() && dialogue->client.idle();
  });
}

/// Serves one dialogue. A client that had to abort a transfer is idle only after its abort was
/// sent.
void BusScan::go_on(Dialogue& dialogue, Time now, Outbox& out) {
  dialogue.client.on_time(now, out);
  if (const auto result = dialogue.client.take_result()) take(dialogue, *result);
  if (dialogue.client.idle() && dialogue.step < identity_objects.size()) {
    dialogue.client.upload(identity_objects[dialogue.step], dialogue.buffer, timeout_);
  }
  dialogue.client.on_time(now, out);
}

Time BusScan::deadline() const noexcept {
  Time earliest = next_ <= last_node && running_.size() < most_at_once_ ? at_once : never;
  for (const auto& dialogue : running_) {
    earliest = std::min(earliest, dialogue->client.deadline());
  }
  return earliest;
}

void BusScan::take(Dialogue& dialogue, const SdoResult& result) {
  if (result.fault == SdoFault::timeout) {
    dialogue.step = identity_objects.size();
    return;
  }
  ScannedNode& node = nodes_[dialogue.node.value()];
  node.answers = true;
  const std::size_t step = dialogue.step++;
  if (result.fault != SdoFault::none) return;  // the node does not have the object
  const auto bytes = std::span{dialogue.buffer}.first(result.size);
  if (step == 0) {
    node.device_type = load_le<std::uint32_t>(bytes);
  } else if (step < name_step) {
    node.identity[step - 1] = load_le<std::uint32_t>(bytes);
  } else {
    node.name = text(bytes);
  }
}

}  // namespace takt
