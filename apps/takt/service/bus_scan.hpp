#pragma once
#include <array>
#include <cstdint>
#include <map>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "eds_parser/values/ids.hpp"
#include "eds_parser/values/time.hpp"
#include "master/core/machine.hpp"
#include "master/core/sdo/sdo_client.hpp"
#include "master/wire/nmt.hpp"

namespace takt {

/// Findings on one node.
struct ScannedNode {
  NmtState state = NmtState::unknown;        ///< state in the newest heartbeat or boot-up message
  bool answers = false;                      ///< true if the SDO server answers
  std::optional<std::uint32_t> device_type;  ///< 0x1000
  /// 0x1018: vendor-ID, product code, revision number and serial number.
  std::array<std::optional<std::uint32_t>, 4> identity;
  std::string name;  ///< 0x1008
};

/// Finds the nodes of a bus: reads 0x1000, 0x1018 and 0x1008 of all 127 node-IDs, several at a
/// time, and listens to heartbeats meanwhile. The scan changes nothing: it sends no NMT command and
/// no remote frame (which would start the life guarding of a device). All calls come from one
/// thread.
class BusScan {
 public:
  /// `timeout` is the longest time that an SDO server may take to answer.
  explicit BusScan(Time timeout, std::size_t most_at_once = 16);

  /// Takes a received frame.
  void on_frame(const Frame& frame, Time now);
  /// Sends the frames that are due. The caller calls it after each frame and at deadline().
  void on_time(Time now, Outbox& out);
  /// Returns the time of the next call of on_time().
  Time deadline() const noexcept;
  /// Returns true if all nodes have been asked.
  bool done() const noexcept { return running_.empty() && next_ > last_node; }

  /// Returns the nodes that were heard, by node-ID.
  const std::map<std::uint8_t, ScannedNode>& nodes() const noexcept { return nodes_; }
  /// Returns true if another SDO client sent requests. Two clients of one server disturb each
  /// other.
  bool met_another_client() const noexcept { return met_another_client_; }

 private:
  /// Questions to one node, object after object.
  struct Dialogue {
    explicit Dialogue(NodeId id) : node{id}, client{id} {}
    NodeId node;
    SdoClient client;
    std::size_t step = 0;
    std::array<std::byte, 64> buffer{};
  };

  void go_on(Dialogue& dialogue, Time now, Outbox& out);
  void take(Dialogue& dialogue, const SdoResult& result);

  static constexpr unsigned last_node = 127;

  Time timeout_;
  std::size_t most_at_once_;
  unsigned next_ = 1;
  std::vector<std::unique_ptr<Dialogue>> running_;
  std::map<std::uint8_t, ScannedNode> nodes_;
  bool met_another_client_ = false;
};

}  // namespace takt
