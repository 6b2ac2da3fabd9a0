#pragma once
#include <cstddef>
#include <cstdint>
#include <vector>

#include "eds_parser/table/bus_plan.hpp"
#include "master/core/pdo/pdo_outputs.hpp"
#include "master/core/request.hpp"

namespace takt {

/// Writes the fallbacks of outputs by SDO while SYNC is lost. A synchronous RPDO takes effect only
/// at the next SYNC, but a value that is written by SDO takes effect at once. The class writes the
/// fallbacks of all outputs in synchronous RPDOs, controlwords first. Devices that refuse SDO
/// writes to mapped objects keep their values until SYNC is back. Bus thread only.
class FallbackWriter {
 public:
  explicit FallbackWriter(const BusPlan& plan);

  /// Begins to write the fallbacks of those outputs that were commanded.
  void begin(const PdoOutputs& outputs) noexcept;
  /// Drops all writes that submitted() has not confirmed yet.
  void stop() noexcept { next_ = values_.size(); }

  /// Returns true if a write waits to be submitted.
  bool waits() const noexcept { return next_ < values_.size(); }
  /// Returns the node index of the write that waits.
  std::size_t node_index() const noexcept { return values_[next_].node_index; }
  /// Returns the request of the write that waits.
  const Request& request() noexcept;
  /// Notes that the network has accepted request().
  void submitted() noexcept;

  /// Returns true if the reply belongs to a request of this class.
  static bool owns(const Reply& reply) noexcept { return reply.id == request_id; }
  /// The id of all requests of this class.
  static constexpr std::uint64_t request_id = 1ULL << 61;

 private:
  struct Value {
    SignalIndex signal = 0;
    std::uint8_t node = 0;
    std::uint8_t node_index = 0;
    std::uint8_t bytes = 0;
    ObjectKey object{};
    std::int64_t value = 0;
  };

  void skip_uncommanded() noexcept;

  std::vector<Value> values_;
  const PdoOutputs* outputs_ = nullptr;
  std::size_t next_ = 0;
  Request request_;
};

}  // namespace takt
