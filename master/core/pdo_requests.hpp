#pragma once
#include <array>
#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

#include "eds_parser/table/bus_plan.hpp"
#include "eds_parser/table/waits.hpp"
#include "master/core/machine.hpp"
#include "master/core/request.hpp"

namespace takt {

/// PDOs on request: remote requests for TPDOs, periodic or asked for, and pairs of an RPDO that is
/// sent and the TPDO of the same number that answers it. Each accepted request is answered once;
/// each wait has a deadline. Bus thread only; nothing allocates after construction.
class PdoRequests {
 public:
  static constexpr std::size_t capacity = waits::pdo_requests;

  explicit PdoRequests(const BusPlan& plan);

  static bool takes(RequestKind kind) noexcept {
    return kind == RequestKind::pdo_poll || kind == RequestKind::pdo_exchange;
  }
  /// False: full, the caller answers.
  bool submit(const Request& request, Time now) noexcept;
  /// Once a cycle: time-outs, then what is to be sent, as far as `out` has room. `exchanging` says
  /// by node index who is OPERATIONAL, `beat` counts SYNCs.
  void on_time(std::span<const bool> exchanging, std::uint64_t beat, Time now,
               Outbox& out) noexcept;
  /// The master itself was away for so long: no answer is late by that.
  void excuse(Time away) noexcept;
  /// Somebody waits for a TPDO: on_frame wants to see those that come.
  bool waiting() const noexcept { return waiting_ != 0 || owed_ != 0; }
  /// `row` of PdoTable::tpdos.
  void on_frame(std::uint16_t row, const StampedFrame& stamped) noexcept;
  bool take(Reply& reply) noexcept;
  /// No request is under way, and no answer is late.
  bool idle() const noexcept { return used_ == 0 && owed_ == 0; }
  /// A request to this node is not answered yet. It may be an exchange that brings it an RPDO.
  bool reaches(std::uint8_t node) const noexcept;
  void cancel_all() noexcept;
  /// Frames of this RPDO that requests have sent; `row` of PdoTable::rpdos.
  std::uint32_t sent(std::size_t row) const noexcept { return sent_[row]; }

  template <class Archive>
  void keep(Archive& state) noexcept {
    state(order_, sent_);
    for (Poll& poll : polls_) state(poll.next, poll.last_beat);
  }

 private:
  struct Poll {
    std::uint16_t row = 0;
    Time next{};
    std::uint64_t last_beat = 0;
  };
  struct Slot {
    enum class State : std::uint8_t { free, to_send, sent, answered };
    State state = State::free;
    SdoFault fault = SdoFault::none;
    std::uint16_t tpdo = 0;
    std::uint16_t rpdo = 0;  ///< of an exchange
    std::uint64_t id = 0;
    std::uint64_t order = 0;
    Frame frame{};  ///< to send, then the answer
    Time timeout{};
    Time deadline{};
    Time sent_at{};
  };

  SdoFault prepare(const Request& request, Slot& slot) const noexcept;
  void answer(Slot& slot, SdoFault fault) noexcept;
  void send(Slot& slot, std::span<const bool> exchanging, Time now, Outbox& out) noexcept;
  bool is_due(const Poll& poll, std::uint64_t beat, Time now) const noexcept;
  bool is_next(const Slot& slot) const noexcept;
  void give_up(Slot& slot, Time now) noexcept;
  void forget_owed(Time now) noexcept;

  const BusPlan& plan_;
  std::vector<Poll> polls_;
  std::array<Slot, capacity> slots_{};
  std::vector<Time> owed_until_;  // by TPDO: the answer to a request that timed out may still come
  std::size_t owed_ = 0;          // TPDOs with one
  std::vector<std::uint32_t> sent_;  // by RPDO
  std::size_t used_ = 0;
  std::size_t waiting_ = 0;
  std::uint64_t order_ = 0;
};

}  // namespace takt
