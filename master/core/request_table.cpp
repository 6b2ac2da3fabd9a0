#include "master/core/request_table.hpp"

namespace takt {
namespace {

constexpr int any_lane = -1;

}  // namespace

const RequestSlot* RequestTable::oldest(RequestSlot::State state, int lane) const noexcept {
  const RequestSlot* found = nullptr;
  for (const RequestSlot& slot : slots_) {
    if (slot.state != state || (found != nullptr && found->order < slot.order)) continue;
    if (lane == any_lane || RequestTable::lane(slot.request) == lane) found = &slot;
  }
  return found;
}

RequestSlot* RequestTable::accept(const Request& request) noexcept {
  const auto slot = std::ranges::find(slots_, RequestSlot::State::free, &RequestSlot::state);
  if (slot == slots_.end()) return nullptr;
  slot->state = RequestSlot::State::waiting;
  slot->order = ++order_;
  slot->request = request;
  ++waiting_;
  return &*slot;
}

bool RequestTable::has_waiting(std::uint8_t lane) const noexcept {
  return waiting_ != 0 && oldest(RequestSlot::State::waiting, lane) != nullptr;
}

bool RequestTable::has_download(std::uint8_t node, ObjectKey object) const noexcept {
  return std::ranges::any_of(slots_, [&](const RequestSlot& slot) {
    const bool open =
        slot.state == RequestSlot::State::waiting || slot.state == RequestSlot::State::active;
    return open && slot.request.kind == RequestKind::sdo_download && slot.request.node == node &&
           slot.request.object == object;
  });
}

RequestSlot* RequestTable::next(std::uint8_t lane) noexcept {
  if (waiting_ == 0) return nullptr;
  const RequestSlot* found = oldest(RequestSlot::State::waiting, lane);
  if (found == nullptr) return nullptr;
  RequestSlot& slot = slots_[static_cast<std::size_t>(found - slots_.data())];
  slot.state = RequestSlot::State::active;
  --waiting_;
  return &slot;
}

void RequestTable::answer(RequestSlot& slot, SdoFault fault, std::uint32_t abort_code,
                          std::size_t size) noexcept {
  if (slot.state == RequestSlot::State::waiting) --waiting_;
  slot.state = RequestSlot::State::answered;
  slot.order = ++order_;  // replies are taken in the order of the answers
  slot.fault = fault;
  slot.abort_code = abort_code;
  slot.request.size = static_cast<std::uint16_t>(size);
  ++answered_;
}

void RequestTable::cancel_all() noexcept {
  for (RequestSlot& slot : slots_) {
    if (slot.state == RequestSlot::State::waiting || slot.state == RequestSlot::State::active) {
      answer(slot, SdoFault::cancelled);
    }
  }
}

void RequestTable::withdraw(std::uint64_t id) noexcept {
  for (RequestSlot& slot : slots_) {
    if (slot.state == RequestSlot::State::waiting && slot.request.id == id) {
      answer(slot, SdoFault::cancelled);
    }
  }
}

bool RequestTable::take(Reply& reply) noexcept {
  if (answered_ == 0) return false;
  const RequestSlot* found = oldest(RequestSlot::State::answered, any_lane);
  RequestSlot& slot = slots_[static_cast<std::size_t>(found - slots_.data())];
  reply.id = slot.request.id;
  reply.fault = slot.fault;
  reply.abort_code = slot.abort_code;
  reply.silence = slot.silence;
  reply.size = slot.request.size;
  std::copy_n(slot.request.data.begin(), reply.size, reply.data.begin());
  slot.silence = {};
  slot.state = RequestSlot::State::free;
  --answered_;
  return true;
}

}  // namespace takt
