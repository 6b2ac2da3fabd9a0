#pragma once
#include <array>
#include <cstdint>
#include <map>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "eds_parser/table/ids.hpp"
#include "eds_parser/table/time.hpp"
#include "master/core/machine.hpp"
#include "master/core/sdo_client.hpp"
#include "master/wire/nmt.hpp"

namespace takt {

/// What a node has shown of itself.
struct ScannedNode {
  NmtState state = NmtState::unknown;        ///< of its newest heartbeat or boot-up message
  bool answers = false;                      ///< its SDO server does
  std::optional<std::uint32_t> device_type;  ///< 0x1000
  std::array<std::optional<std::uint32_t>, 4> identity;  ///< 0x1018: vendor to serial number
  std::string name;                                      ///< 0x1008
};

/// Who is on a bus: reads 0x1000, 0x1018 and 0x1008 of all 127 nodes, some at a time, and listens
/// to heartbeats meanwhile. Changes nothing; sends no NMT command and no remote frame (which would
/// start the life guarding of a device). One thread.
class BusScan {
 public:
  /// `timeout`: longest silence of a node that is there.
  explicit BusScan(Time timeout, std::size_t most_at_once = 16);

  void on_frame(const Frame& frame, Time now);
  void on_time(Time now, Outbox& out);
  Time deadline() const noexcept;
  bool done() const noexcept { return running_.empty() && next_ > last_node; }

  /// By node id; only those that were heard.
  const std::map<std::uint8_t, ScannedNode>& nodes() const noexcept { return nodes_; }
  /// Requests to nodes that were not ours: two clients of one server confuse each other.
  bool met_another_client() const noexcept { return met_another_client_; }

 private:
  /// One node being asked, object after object.
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
