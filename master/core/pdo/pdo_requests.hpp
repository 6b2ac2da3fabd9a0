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

/// Serves PDOs on request. There are two kinds of them: remote frames for TPDOs, sent periodically
/// or for a request, and exchanges, in which the master sends an RPDO and the device answers with
/// the TPDO of the same number. Each accepted request is answered once, and each wait has a
/// deadline. Bus thread only. No function allocates memory after the construction.
class PdoRequests {
 public:
  static constexpr std::size_t capacity = waits::pdo_requests;

  explicit PdoRequests(const BusPlan& plan);

  /// Returns true for the kinds of request that this class serves.
  static bool takes(RequestKind kind) noexcept {
    return kind == RequestKind::pdo_poll || kind == RequestKind::pdo_exchange;
  }
  /// Accepts a request. Returns false if there is no room; then the caller answers the request.
  bool submit(const Request& request, Time now) noexcept;
  /// Handles time-outs and then sends frames as far as `out` has room. Call this once a cycle.
  /// `exchanging` states by node index which nodes are OPERATIONAL; `beat` counts SYNCs.
  void on_time(std::span<const bool> exchanging, std::uint64_t beat, Time now,
               Outbox& out) noexcept;
  /// Extends all time-outs by the time for which the master itself did not run.
  void extend_deadlines(Time away) noexcept;
  /// Returns true if a request waits for a TPDO, so on_frame() needs the TPDOs that come.
  bool waiting() const noexcept { return waiting_ != 0 || late_answers_ != 0; }
  /// Takes a received TPDO; `row` is the index into PdoTable::tpdos.
  void on_frame(std::uint16_t row, const StampedFrame& stamped) noexcept;
  /// Takes the next reply. Returns false if there is none.
  bool take(Reply& reply) noexcept;
  /// Returns true if there is no request, and no late answer can still come.
  bool idle() const noexcept { return used_ == 0 && late_answers_ == 0; }
  /// Returns true if a request to this node is not answered yet. The request may be an exchange
  /// that sends an RPDO.
  bool reaches(std::uint8_t node) const noexcept;
  /// Cancels and answers all requests.
  void cancel_all() noexcept;
  /// Returns the number of frames of this RPDO that requests have sent; `row` is the index into
  /// PdoTable::rpdos.
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
    std::uint16_t rpdo = 0;  ///< row of the RPDO; exchanges only
    std::uint64_t id = 0;
    std::uint64_t order = 0;
    Frame frame{};  ///< the frame to send, later the answer
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
  void forget_late_answers(Time now) noexcept;

  const BusPlan& plan_;
  std::vector<Poll> polls_;
  std::array<Slot, capacity> slots_{};
  // For each TPDO: the time until which the answer to a request that has timed out may still come.
  std::vector<Time> late_answer_until_;
  std::size_t late_answers_ = 0;     // number of TPDOs with such an answer
  std::vector<std::uint32_t> sent_;  // number of frames by RPDO
  std::size_t used_ = 0;
  std::size_t waiting_ = 0;
  std::uint64_t order_ = 0;
};

}  // namespace takt
