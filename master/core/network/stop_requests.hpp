#pragma once
#include <cstddef>
#include <cstdint>
#include <optional>
#include <span>
#include <vector>

#include "eds_parser/table/bus_plan.hpp"
#include "master/core/network/ordered_stop.hpp"
#include "master/core/request.hpp"

namespace takt {

/// The requests that an ordered stop makes by itself: it reads the values of an axis that no PDO
/// carries, writes a controlword that no PDO carries, and disarms the supervision of the master by
/// the devices. Bus thread only.
class StopRequests {
 public:
  explicit StopRequests(const BusPlan& plan);

  /// Begins the requests of a stop.
  void begin() noexcept;
  /// Notes whether the boot of this node has failed because the device refused its newest step.
  void note_boot(std::size_t node_index, bool refused) noexcept {
    refused_boots_[node_index] = refused;
  }
  /// Returns the next request that is due, or nullptr. `exchanging` is as in StopView.
  const Request* next(Time now, const OrderedStop& stop, std::span<const bool> exchanging,
                      std::span<const NodeStatus> nodes) noexcept;
  /// Notes that the network has accepted the request from next().
  void submitted() noexcept;

  /// Returns true if the reply belongs to a request of this class.
  static bool owns(const Reply& reply) noexcept { return (reply.id & mark) != 0; }
  /// Passes the values that were read to `stop`. Returns false if the device did not accept a write
  /// that disarms it; see refusing_node() and refused_object().
  bool take(const Reply& reply, Time now, OrderedStop& stop) noexcept;
  /// Returns the node-ID of the newest take() that returned false.
  std::uint8_t refusing_node() const noexcept { return refused_.node; }
  /// Returns the object of the newest take() that returned false.
  ObjectKey refused_object() const noexcept { return refused_.object; }
  /// Returns the `Event::value` for EventKind::still_armed.
  std::int64_t refusal() const noexcept { return refusal_; }

  /// A statusword that was read by SDO.
  struct AxisWord {
    std::size_t axis = 0;
    std::int64_t value = 0;
  };
  /// Returns the statusword in a reply, or std::nullopt if the reply carries none.
  static std::optional<AxisWord> statusword_of(const Reply& reply) noexcept;
  /// Returns the index of the controlword (0x6040 of the first axis) of this axis.
  static constexpr std::uint16_t controlword_of(const StopAxis& axis) noexcept {
    return static_cast<std::uint16_t>(0x6040 + axis.number * axis_step);
  }

  /// Returns true if all writes that disarm devices are answered or were skipped.
  bool disarmed() const noexcept { return answered_ == jobs_.size(); }

 private:
  enum class Word : std::uint8_t { status, velocity, position, control, device_type };
  /// A device that has no statusword is asked for its device type once.
  enum class TypeQuery : std::uint8_t { not_needed, due, answered };
  struct Poll {
    bool waiting = false;      // the axis waits for an answer
    bool by_position = false;  // 0x6064 is read, not 0x606C
    bool word_next = false;    // the newest read was that of the statusword
    TypeQuery type = TypeQuery::not_needed;
    std::int64_t writing = -1;  // controlword that is being written by SDO; -1 means none
    std::int64_t written = -1;  // controlword that the device has accepted by SDO; -1 means none
    Time due{};
    Time asked{};        // time at which the newest request was made
    Time write_again{};  // earliest next write, after the device has refused a controlword
  };
  /// One write that disarms a device. Without an object, the job is the NMT command enter
  /// pre-operational, which comes before the writes.
  struct Job {
    std::uint8_t node = 0;
    std::uint8_t node_index = 0;
    ObjectKey object{};
    std::uint8_t bytes = 0;
    std::uint16_t step = 0;  ///< step of the boot that arms the device
    Time timeout{};
  };
  static constexpr std::uint64_t mark = 1ULL << 60;
  static constexpr std::uint64_t of_job = 1ULL << 59;
  // Index distance between two axes of one device.
  static constexpr std::uint16_t axis_step = 0x800;

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
  std::vector<std::uint8_t> failed_;  // by node: the node accepted no write, or does not exist
  std::vector<bool> refused_boots_;   // by node: the note of note_boot()
  std::size_t next_job_ = 0;
  std::size_t answered_ = 0;  // answered jobs
  std::size_t turn_ = 0;      // axis that is served next
  std::size_t asked_ = 0;     // axis or job of request_
  Job refused_;
  std::int64_t refusal_ = 0;
  Request request_;
};

}  // namespace takt
