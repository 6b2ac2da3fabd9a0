#include "master/sim/pdo/multiplexed_pdos.hpp"

#include "master/wire/bytes.hpp"

namespace takt::sim {
namespace {

constexpr std::uint16_t first_scanner = 0x1FA0;
constexpr std::uint16_t last_scanner = 0x1FCF;
constexpr std::uint16_t first_dispatcher = 0x1FD0;
constexpr std::uint16_t last_dispatcher = 0x1FFF;
constexpr std::uint8_t destination = 0x80;  ///< with node-ID 0, the frame is for all nodes
constexpr std::uint16_t not_available = 0x8230;
constexpr unsigned widest = 4;  ///< most data bytes in a frame

}  // namespace

MultiplexedPdos::MultiplexedPdos(ObjectStore& store, NodeId node) : store_{store}, node_{node} {
  sources_.reserve(most_sources);
}

void MultiplexedPdos::add(const PdoRecord& tpdo) noexcept {
  if (!tpdo.valid()) return;
  if (tpdo.multiplex() == Multiplex::source) add_scanned(tpdo);
  if (tpdo.multiplex() == Multiplex::destination) add_mapped(tpdo);
}

void MultiplexedPdos::add_source(const PdoRecord& tpdo, ObjectKey key,
                                 std::uint8_t address) noexcept {
  const Object* object = store_.find(key);
  if (object == nullptr || object->is_bytes() || object->width > widest) return;
  if (sources_.size() == most_sources) return;
  sources_.push_back({.object = object, .id = tpdo.id(), .address = address});
}

/// An entry of the scanner list is block size << 24 | index << 8 | sub-index.
void MultiplexedPdos::add_scanned(const PdoRecord& tpdo) noexcept {
  for (const Object& list : store_.range(first_scanner, last_scanner)) {
    if (list.key.sub == 0 || list.value == 0) continue;
    const auto block = static_cast<unsigned>(list.value >> 24 & 0xFF);
    for (unsigned i = 0; i < (block == 0 ? 1 : block); ++i) {
      const ObjectKey key{static_cast<std::uint16_t>(list.value >> 8),
                          static_cast<std::uint8_t>(list.value + i)};
      add_source(tpdo, key, node_.value());
    }
  }
}

void MultiplexedPdos::add_mapped(const PdoRecord& tpdo) noexcept {
  const std::uint16_t mapping = tpdo.mapping_index();
  for (const Object& entry : store_.range(mapping, mapping)) {
    if (entry.key.sub == 0 || entry.value == 0) continue;
    const ObjectKey key{static_cast<std::uint16_t>(entry.value >> 16),
                        static_cast<std::uint8_t>(entry.value >> 8)};
    add_source(tpdo, key, destination);
  }
}

void MultiplexedPdos::send_changes(Time now, Transmitter& out) noexcept {
  for (Source& source : sources_) {
    if (source.sent && source.object->value == source.last) continue;
    source.sent = true;
    source.last = source.object->value;
    const ObjectKey key = source.object->key;
    const auto byte = [&](unsigned i) { return static_cast<std::uint8_t>(source.last >> (8 * i)); };
    out.send(make_frame(source.id, {source.address, static_cast<std::uint8_t>(key.index),
                                    static_cast<std::uint8_t>(key.index >> 8), key.sub, byte(0),
                                    byte(1), byte(2), byte(3)}),
             now);
  }
}

bool MultiplexedPdos::on_frame(const PdoRecord& rpdo, const Frame& frame,
                               EmcyProducer& emcy) noexcept {
  const auto number = static_cast<std::uint8_t>(rpdo.number());
  if (frame.length < 8) {
    emcy.raise(too_short, ErrorBit::communication, {number});
    return false;
  }
  emcy.clear(too_short, number);
  const auto data = load_le<std::uint32_t>(std::span{frame.data}.subspan(4));
  const bool by_destination = (frame.data[0] & destination) != 0;
  if (rpdo.multiplex() == Multiplex::source) return !by_destination && dispatch(frame, data);
  const unsigned address = frame.data[0] & 0x7F;
  if (!by_destination || (address != 0 && address != node_.value())) return false;
  const auto index = static_cast<std::uint16_t>(frame.data[1] | frame.data[2] << 8);
  if (write({index, frame.data[3]}, data)) {
    emcy.clear(not_available, number);
    return true;
  }
  emcy.raise(not_available, ErrorBit::communication, {number});
  return false;
}

bool MultiplexedPdos::write(ObjectKey key, std::uint32_t data) noexcept {
  Object* object = store_.find(key);
  if (object == nullptr || !object->writable() || object->is_bytes() || object->width > widest) {
    return false;
  }
  object->set(data);
  return true;
}

/// An entry of the dispatcher list is block size << 56 | local index << 40 | local sub-index << 32
/// | index << 16 | sub-index << 8 | node-ID.
bool MultiplexedPdos::dispatch(const Frame& frame, std::uint32_t data) noexcept {
  bool any = false;
  for (const Object& entry : store_.range(first_dispatcher, last_dispatcher)) {
    const std::uint64_t rule = entry.value;
    if (entry.key.sub == 0 || (rule & 0xFF) != frame.data[0]) continue;
    const auto block = static_cast<unsigned>(rule >> 56);
    const unsigned offset = frame.data[3] - static_cast<unsigned>(rule >> 8 & 0xFF);
    const auto index = static_cast<std::uint16_t>(frame.data[1] | frame.data[2] << 8);
    const bool same_index = static_cast<std::uint16_t>(rule >> 16) == index;
    if (!same_index || offset >= (block == 0 ? 1 : block)) continue;
    any |= write(
        {static_cast<std::uint16_t>(rule >> 40), static_cast<std::uint8_t>((rule >> 32) + offset)},
        data);
  }
  return any;
}

}  // namespace takt::sim
