#pragma once
#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <vector>

#include "master/core/request.hpp"

namespace takt {

/// One accepted request from its arrival until its reply is taken. An upload is received into
/// `request.data`.
struct RequestSlot {
  enum class State : std::uint8_t { free, waiting, active, answered };
  State state = State::free;
  std::uint64_t order = 0;
  Request request;
  SdoFault fault = SdoFault::none;
  std::uint32_t abort_code = 0;
  SdoSilence silence{};
};

/// The requests of applications. Each request belongs to a lane: there is one lane for the SDO
/// requests of each node, lane 0 for NMT, and one for LSS. In each lane the requests are served in
/// the order of their arrival. Every accepted request is answered once. Bus thread only.
class RequestTable {
 public:
  static constexpr std::size_t capacity = 32;
  static constexpr std::uint8_t lss_lane = 128;

  RequestTable() : slots_(capacity) {}

  /// Returns the lane in which a request waits.
  static std::uint8_t lane(const Request& request) noexcept {
    if (request.kind == RequestKind::lss) return lss_lane;
    return request.kind == RequestKind::nmt ? std::uint8_t{0} : request.node;
  }
  bool full() const noexcept {
    return std::ranges::find(slots_, RequestSlot::State::free, &RequestSlot::state) == slots_.end();
  }
  /// Accepts a request. Returns nullptr if there is no room.
  RequestSlot* accept(const Request& request) noexcept;
  /// Makes the oldest waiting request of a lane the active one. Returns nullptr if no request
  /// waits.
  RequestSlot* next(std::uint8_t lane) noexcept;
  bool has_waiting(std::uint8_t lane) const noexcept;
  /// Returns true if an SDO download to this object of the node is not answered yet.
  bool has_download(std::uint8_t node, ObjectKey object) const noexcept;
  void answer(RequestSlot& slot, SdoFault fault, std::uint32_t abort_code = 0,
              std::size_t size = 0) noexcept;
  /// Cancels and answers all requests that wait or are active.
  void cancel_all() noexcept;
  /// Cancels and answers the requests with this id that still wait.
  void withdraw(std::uint64_t id) noexcept;
  /// Takes the oldest reply. Returns false if there is none.
  bool take(Reply& reply) noexcept;
  /// Returns true if there is no request, and no reply that take() has not returned yet.
  bool idle() const noexcept { return waiting_ == 0 && answered_ == 0; }

  template <class Archive>
  void keep(Archive& state) noexcept {
    state(order_);
  }

 private:
  const RequestSlot* oldest(RequestSlot::State state, int lane) const noexcept;

  std::vector<RequestSlot> slots_;
  std::size_t waiting_ = 0;
  std::size_t answered_ = 0;
  std::uint64_t order_ = 0;
};

}  // namespace takt
