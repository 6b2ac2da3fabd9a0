#pragma once
#include <cstddef>
#include <cstdint>
#include <vector>

#include "eds_parser/values/time.hpp"
#include "master/sim/dictionary/object_store.hpp"
#include "master/sim/pdo/pdo_record.hpp"
#include "master/sim/service/emcy_producer.hpp"
#include "master/sim/service/transmitter.hpp"
#include "master/wire/frame.hpp"

namespace takt::sim {

/// The multiplexed PDOs (MPDO) of a device. The device sends objects of its scanner list (0x1FA0..)
/// by source address, and mapped objects by destination address to all nodes, whenever they change.
/// It accepts frames addressed to it and frames that its dispatcher list (0x1FD0..) names. CiA 301,
/// 7.2.3.
class MultiplexedPdos {
 public:
  MultiplexedPdos(ObjectStore& store, NodeId node);
  /// Sets the node-ID that LSS has given to the device.
  void set_node(NodeId node) noexcept { node_ = node; }

  /// Clears the list of sources. Called on entering OPERATIONAL and after a write to an object of a
  /// PDO, before add().
  void clear() noexcept { sources_.clear(); }
  void add(const PdoRecord& tpdo) noexcept;
  bool wants_events() const noexcept { return !sources_.empty(); }
  /// Sends the values that have changed since the last call.
  void notice(Time now, Transmitter& out) noexcept {
    if (wants_events()) send_changes(now, out);
  }

  /// Returns true if the frame has written an object.
  bool on_frame(const PdoRecord& rpdo, const Frame& frame, EmcyProducer& emcy) noexcept;

 private:
  struct Source {
    const Object* object = nullptr;
    CobId id;
    std::uint8_t address = 0;  ///< byte 0 of the frame
    bool sent = false;
    std::uint64_t last = 0;
  };
  static constexpr std::size_t most_sources = 512;

  void send_changes(Time now, Transmitter& out) noexcept;
  void add_source(const PdoRecord& tpdo, ObjectKey key, std::uint8_t address) noexcept;
  void add_scanned(const PdoRecord& tpdo) noexcept;
  void add_mapped(const PdoRecord& tpdo) noexcept;
  bool write(ObjectKey key, std::uint32_t data) noexcept;
  bool dispatch(const Frame& frame, std::uint32_t data) noexcept;

  ObjectStore& store_;
  NodeId node_;
  std::vector<Source> sources_;
};

}  // namespace takt::sim
