#pragma once
#include <cstddef>
#include <cstdint>
#include <vector>

#include "eds_parser/table/bus_plan.hpp"
#include "master/core/pdo_outputs.hpp"
#include "master/core/request.hpp"

namespace takt {

/// While SYNC is lost, a synchronous RPDO waits in the device for the next one. This writes the
/// fallbacks in such RPDOs by SDO as well, controlwords first: they act at once. Devices that take
/// no SDO writes to mapped objects keep what they have until SYNC is back. Bus thread only.
class FallbackWriter {
 public:
  explicit FallbackWriter(const BusPlan& plan);

  /// The commanded ones of these outputs have taken their fallback.
  void begin(const PdoOutputs& outputs) noexcept;
  void stop() noexcept { next_ = values_.size(); }

  bool waits() const noexcept { return next_ < values_.size(); }
  /// Node index of the one that waits.
  std::size_t node_index() const noexcept { return values_[next_].node_index; }
  /// The write that waits.
  const Request& request() noexcept;
  void submitted() noexcept;

  /// The answer to one of these requests: nobody else asked.
  static bool owns(const Reply& reply) noexcept { return reply.id == request_id; }
  /// Of all its requests.
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
