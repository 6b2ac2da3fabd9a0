#include "master/gateway/message/status_messages.hpp"
#include "master/lcm/messages.hpp"

namespace takt {
namespace {

pdo_state_t base_of(const PdoRow& row) {
  pdo_state_t state{};
  state.node_id = row.node.value();
  state.number = static_cast<std::int16_t>(row.number);
  state.cob_id = static_cast<std::int32_t>(row.cob_id.id());
  state.extended = row.cob_id.is_extended() ? 1 : 0;
  state.transmission = row.transmission;
  state.header = row.header;
  return state;
}

pdo_state_t tpdo_state(const PdoRow& row, const PdoStatus& status, const PdoMark& mark,
                       std::uint64_t cycle) {
  pdo_state_t state = base_of(row);
  state.count = mark.received;
  state.toggle = mark.toggle() ? 1 : 0;
  state.age = mark.received == 0
                  ? -1
                  : static_cast<std::int32_t>(static_cast<std::uint32_t>(cycle) - mark.cycle);
  state.stale = status.stale ? 1 : 0;
  state.flags = mark.flags;
  state.missing = status.missing;
  state.late = status.late;
  state.too_short = status.length_errors - status.too_long;
  state.too_long = status.too_long;
  return state;
}

pdo_state_t rpdo_state(const PdoRow& row, const RpdoStatus& status) {
  pdo_state_t state = base_of(row);
  state.output = 1;
  state.count = status.sent;
  state.toggle = static_cast<std::int8_t>(status.sent & 1);
  state.age = -1;
  state.stale = status.ready || row.on_request ? 0 : 1;
  return state;
}

}  // namespace

std::vector<pdo_status_t> pdo_messages(const BusPlan& plan, const StatusSnapshot& snapshot,
                                       std::span<const PdoMark> marks, std::uint64_t cycle) {
  std::vector<pdo_status_t> messages;
  const auto add = [&](const pdo_state_t& state) {
    if (messages.empty() || messages.back().pdos.size() == pdos_a_message) messages.emplace_back();
    messages.back().pdos.push_back(state);
  };
  for (std::size_t i = 0; i < plan.pdos.tpdos.size() && i < snapshot.tpdos.size(); ++i) {
    const PdoMark mark = i < marks.size() ? marks[i] : PdoMark{};
    add(tpdo_state(plan.pdos.tpdos[i], snapshot.tpdos[i], mark, cycle));
  }
  for (std::size_t i = 0; i < plan.pdos.rpdos.size() && i < snapshot.rpdos.size(); ++i) {
    add(rpdo_state(plan.pdos.rpdos[i], snapshot.rpdos[i]));
  }
  number_parts(messages);
  for (pdo_status_t& message : messages) {
    message.schema = message_schema;
    message.cycle = static_cast<std::int64_t>(cycle);
    message.num_pdos = static_cast<std::int32_t>(message.pdos.size());
  }
  return messages;
}

}  // namespace takt
