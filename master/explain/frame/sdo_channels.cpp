#include "master/explain/frame/sdo_channels.hpp"

#include <algorithm>
#include <fmt/format.h>

#include "master/wire/bytes.hpp"

namespace takt {
namespace {

constexpr unsigned nodes = 127;
constexpr std::uint16_t second_server = 0x1201;
constexpr std::uint16_t last_server = 0x127F;
constexpr std::uint32_t not_valid = 0x8000'0000;
constexpr std::uint32_t extended_bit = 0x2000'0000;

std::optional<CobId> cob_id(const DeviceTable& device, ObjectKey key) {
  const auto at = std::ranges::lower_bound(device.objects, key, {}, &DeviceObject::key);
  if (at == device.objects.end() || at->key != key || at->value.size() != 4) return {};
  const auto raw = load_le<std::uint32_t>(std::span{at->value});
  if ((raw & not_valid) != 0 || (raw & 0x1FFF'FFFF) == 0) return {};
  return (raw & extended_bit) != 0 ? CobId::extended(raw) : CobId::base(raw);
}

/// Returns the name of a node with its channel: `shoulder`, `shoulder (channel 2)`.
std::string speaker(const FrameNames& names, unsigned node, unsigned number) {
  if (number == 1) return names.node(node);
  return fmt::format("{} (channel {})", names.node(node), number);
}

}  // namespace

SdoChannels::SdoChannels(const FrameNames& names) : names_{&names} {
  channels_.reserve(nodes);
  for (unsigned node = 1; node <= nodes; ++node) {
    channels_.push_back({.node = node,
                         .ids = default_sdo_channel(NodeId::from(node).value()),
                         .number = 1,
                         .text = SdoText{names, node}});
  }
}

SdoChannels::SdoChannels(const FrameNames& names, const BusPlan& plan,
                         std::span<const DeviceTable> devices)
    : SdoChannels{names} {
  for (const DeviceTable& device : devices) {
    for (std::uint16_t index = second_server; index <= last_server; ++index) {
      const auto request = cob_id(device, {index, 1});
      const auto answer = cob_id(device, {index, 2});
      if (request && answer) add(device.node.value(), {*request, *answer});
    }
  }
  for (const NodePlan& node : plan.nodes) {
    if (node.sdo.channel) add(node.id.value(), *node.sdo.channel);
  }
}

void SdoChannels::add(unsigned node, const SdoChannel& ids) {
  const auto known = [&](const Channel& channel) {
    return channel.node == node && channel.ids == ids;
  };
  if (std::ranges::any_of(channels_, known)) return;
  const auto number = std::ranges::count(channels_, node, &Channel::node) + 1;
  channels_.push_back({.node = node,
                       .ids = ids,
                       .number = static_cast<unsigned>(number),
                       .text = SdoText{*names_, node}});
}

std::optional<FrameMeaning> SdoChannels::meaning(const Frame& frame) {
  const auto speaks = [&](const Channel& channel) {
    return channel.ids.request == frame.id || channel.ids.answer == frame.id;
  };
  // A configured channel takes precedence over the default channel of another node that has the
  // same COB-ID.
  auto found = std::ranges::find_if(channels_.begin() + nodes, channels_.end(), speaks);
  if (found == channels_.end()) {
    const unsigned node = frame.id.id() & 0x7F;
    if (frame.id.is_extended() || node == 0 || !speaks(channels_[node - 1])) return {};
    found = channels_.begin() + (node - 1);
  }
  const bool asks = found->ids.request == frame.id;
  const std::string who = speaker(*names_, found->node, found->number);
  if (frame.rtr) return FrameMeaning{"SDO", found->node, who + " remote request"};
  return FrameMeaning{.service = "SDO",
                      .node = found->node,
                      .text = asks ? who + " is asked: " + found->text.request(frame)
                                   : who + " answers: " + found->text.answer(frame)};
}

}  // namespace takt
