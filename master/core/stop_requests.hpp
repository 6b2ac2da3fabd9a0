#pragma once
#include <cstddef>
#include <cstdint>
#include <optional>
#include <span>
#include <vector>

#include "eds_parser/table/bus_plan.hpp"
#include "master/core/ordered_stop.hpp"
#include "master/core/request.hpp"

namespace takt {

/// The requests that an ordered stop makes by itself: it reads of an axis what no PDO brings,
/// writes a controlword that no PDO carries, and disarms what the devices watch of the master.
/// Bus thread only.
class StopRequests {
 public:
  explicit StopRequests(const BusPlan& plan);

  /// A stop begins.
  void begin() noexcept;
  /// Says whether the boot of this node has failed because the device refused its newest step.
  void note_boot(std::size_t node_index, bool refused) noexcept {
    refused_boots_[node_index] = refused;
  }
  /// The next request that is due; null: none. `exchanging` as in StopView.
  const Request* next(Time now, const OrderedStop& stop, std::span<const bool> exchanging,
                      std::span<const NodeStatus> nodes) noexcept;
  /// The network has taken what next() gave.
  void submitted() noexcept;

  /// The answer to one of these requests: nobody else asked.
  static bool owns(const Reply& reply) noexcept { return (reply.id & mark) != 0; }
  /// Hands what was read to `stop`. False: the device did not take a write that disarms it; see
  /// refusing_node() and refused_object().
  bool take(const Reply& reply, Time now, OrderedStop& stop) noexcept;
  /// Of the newest take() that gave false.
  std::uint8_t refusing_node() const noexcept { return refused_.node; }
  ObjectKey refused_object() const noexcept { return refused_.object; }
  /// Value of EventKind::still_armed.
  std::int64_t refusal() const noexcept { return refusal_; }

  /// A statusword that such an answer brings.
  struct AxisWord {
    std::size_t axis = 0;
    std::int64_t value = 0;
  };
  static std::optional<AxisWord> statusword_of(const Reply& reply) noexcept;
  /// Index of 0x6040 of this axis.
  static constexpr std::uint16_t controlword_of(const StopAxis& axis) noexcept {
    return static_cast<std::uint16_t>(0x6040 + axis.number * axis_step);
  }

  /// Everything that can be disarmed by SDO is.
  bool disarmed() const noexcept { return answered_ == jobs_.size(); }

 private:
  enum class Word : std::uint8_t { status, velocity, position, control, device_type };
  /// A device that has no statusword is asked for its device type once.
  enum class TypeQuery : std::uint8_t { not_needed, due, answered };
  struct Poll {
    bool waiting = false;      // for an answer
    bool no_velocity = false;  // the device has no 0x606C
    bool word_next = false;    // the statusword was read last
    TypeQuery type = TypeQuery::not_needed;
    std::int64_t writing = -1;  // controlword that is under way by SDO
    std::int64_t written = -1;  // controlword that the device has taken by SDO
    Time due{};
    Time write_again{};  // not before, after the device has refused a controlword
  };
  /// One write that disarms; without object: NMT enter pre-operational, before the writes.
  struct Job {
    std::uint8_t node = 0;
    std::uint8_t node_index = 0;
    ObjectKey object{};
    std::uint8_t bytes = 0;
    std::uint16_t step = 0;  ///< of the boot, that arms it
    Time timeout{};
  };
  static constexpr std::uint64_t mark = 1ULL << 60;
  static constexpr std::uint64_t of_job = 1ULL << 59;
  static constexpr std::uint16_t axis_step = 0x800;  // between two axes of one device

  void add_jobs(const BusPlan& plan, std::uint8_t node_index);
  bool due_of_axis(std::size_t axis, Time now, const OrderedStop& stop, bool exchanging) noexcept;
  bool read_next(std::size_t axis, bool needs_word, bool needs_motion) noexcept;
  void ask(std::size_t axis, Word word, std::int64_t value = 0) noexcept;
  bool armed(const Job& job, const NodeStatus& node) const noexcept;
  const Request* next_job(std::span<const NodeStatus> nodes) noexcept;
  void take_value(std::size_t axis, Word word, const Reply& reply, OrderedStop& stop) noexcept;
  void take_fault(std::size_t axis, Word word, const Reply& reply, OrderedStop& stop) noexcept;

  const BusPlan& plan_;
  std::vector<StopAxis> axes_;
  std::vector<Poll> polls_;
  std::vector<Job> jobs_;
  std::vector<std::uint8_t> failed_;  // per node: it took no write, or is not there
  std::vector<bool> refused_boots_;   // per node, see note_boot()
  std::size_t next_job_ = 0;
  std::size_t answered_ = 0;  // jobs
  std::size_t turn_ = 0;      // axis that is asked next
  std::size_t asked_ = 0;     // axis, or job, that request_ is of
  Job refused_;
  std::int64_t refusal_ = 0;
  Request request_;
};

}  // namespace takt
