#include "eds_parser/values/pdo_number.hpp"
#include "master/sim/device/device.hpp"

// The changes that LSS makes to a device.

namespace takt::sim {
namespace {

/// Returns true if the entry holds the COB-ID of a communication object. CiA 301, 7.3.3.
bool holds_cob_id(ObjectKey key) noexcept {
  if (key.index == 0x1014) return key.sub == 0;
  if (key.index >= 0x1200 && key.index <= 0x127F) return key.sub == 1 || key.sub == 2;
  return is_pdo_cob_id(key);
}

/// Identifiers of the predefined connection set follow the node-ID; others do not change. CiA 301,
/// 7.3.5.
std::uint64_t moved(std::uint64_t cob_id, NodeId from, NodeId to) noexcept {
  constexpr std::uint64_t extended = 1u << 29;
  if ((cob_id & extended) != 0 || (cob_id & 0x7F) != from.value()) return cob_id;
  return (cob_id & ~std::uint64_t{0x7F}) | to.value();
}

}  // namespace

std::optional<NodeId> Device::address() const noexcept {
  if (speaks_only_lss()) return {};
  return address_;
}

void Device::on_lss(const Frame& frame, Time now) noexcept {
  lss_->on_frame(frame, now, out_);
  if (lss_->take_start()) reset_communication(now);
}

/// Activates the node-ID that LSS has configured. Called at each reset.
void Device::take_address() noexcept {
  if (!lss_) return;
  lss_->reset();
  const auto address = NodeId::from(lss_->node_id());
  if (!address || *address == address_) return;
  for (Object& object : store_.range(0x1000, 0x1FFF)) {
    if (!holds_cob_id(object.key)) continue;
    object.power_on = moved(object.power_on, address_, *address);
    object.factory = moved(object.factory, address_, *address);
  }
  address_ = *address;
  emcy_.set_node(address_);
  sdo_.front().set_channel(CobId::base(0x600u + address_.value()),
                           CobId::base(0x580u + address_.value()));
  heartbeat_.set_node(address_);
  guarding_.set_node(address_);
  multiplexed_.set_node(address_);
}

}  // namespace takt::sim
