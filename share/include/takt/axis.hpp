#pragma once
/// @file
/// Commands the CiA 402 axes of one bus over LCM.
#include <Eigen/Core>
#include <chrono>
#include <cstdint>
#include <memory>
#include <optional>
#include <span>
#include <string>
#include <takt/axis_control.hpp>
#include <takt/axis_motion_t.hpp>
#include <takt/event_t.hpp>
#include <takt/image_input.hpp>
#include <takt/lcm.hpp>
#include <takt/motion_command_t.hpp>
#include <takt/motion_gear_t.hpp>
#include <takt/motion_stream_t.hpp>
#include <takt/node_status_t.hpp>
#include <takt/reply_t.hpp>
#include <takt/request_t.hpp>
#include <takt/speed_axis_t.hpp>
#include <vector>

namespace takt {

/// The program that commands the outputs of a node, as the newest status_t shows it.
struct NodeHolder {
  std::string name;  ///< name of its sender; empty if nobody commands the outputs
  bool own = false;  ///< true if this is the program that asks
  int statuses = 0;  ///< number of status_t in sequence that show this holder; 10 in a second

  /// Returns true if at least the newest `sequence` status_t show the same other program.
  bool is_other(int sequence = 1) const noexcept {
    return !name.empty() && !own && statuses >= sequence;
  }
};

/// Options of an AxisGroup.
struct AxisGroupOptions {
  /// Name of the bus in the network file. Empty selects the first bus whose layout arrives.
  std::string bus;
  /// Name of the program in events and in status_t; AxisGroup::sender() adds digits of the instance
  /// to it, so several programs may have the same name. One sender holds the outputs of a node at a
  /// time.
  std::string sender = "axes";
  /// The newest image is stale if it is older than this number of cycles.
  std::int32_t stale_cycles = 5;
  /// Time to live of the commands, in cycles. 0 selects the configured one; the shorter of both
  /// counts.
  std::int32_t time_to_live = 20;
  /// Number by which taktd distinguishes senders. 0 selects a random number.
  std::int64_t instance = 0;
};

/// Results of AxisGroup::wait().
enum class Input : std::uint8_t {
  fresh,      ///< A new image has arrived.
  nothing,    ///< No image arrived in the given time.
  stale,      ///< The newest image is older than `stale_cycles`. Each gap is reported once.
  restarted,  ///< A new layout or a new run of taktd; every goal is DriveGoal::disabled again.
};

/// Commands the axes of one bus over LCM. Only the newest image counts; older ones that wait in the
/// queue are skipped. Each command carries the session and the cycle of the image from which it was
/// computed. All calls come from one thread; only wait() waits.
class AxisGroup {
 public:
  /// Subscribes to the channels of the bus. open_lcm() makes the transport.
  AxisGroup(std::unique_ptr<Transport> lcm, AxisGroupOptions options);
  /// Calls release().
  ~AxisGroup();
  AxisGroup(const AxisGroup&) = delete;
  AxisGroup& operator=(const AxisGroup&) = delete;

  /// Puts all further commands into envelopes with this key. This is necessary if `keys` is
  /// configured for taktd.
  void sign_with(EnvelopeKey key);
  /// Waits at most `longest` for the next image, and steps the axes with it.
  Input wait(std::chrono::nanoseconds longest);
  /// Sets the time to live of all further commands, in cycles. 0 selects the configured one.
  void set_time_to_live(std::int32_t cycles) noexcept;
  /// Sends the set-points of all axes. Returns false if LCM did not take the message.
  bool send();
  /// Gives up the outputs that this group commands. They take their fallback at once, without a
  /// warning, and another sender may take them over. The next send() requests them again. Returns
  /// false if LCM did not take the message.
  bool release();
  /// Sets a target position for each axis and sends all of them as one command. If the RPDOs are
  /// synchronous, all target positions become valid with one SYNC. Axes that are not in Operation
  /// enabled keep to their actual position. Returns false if LCM did not take the message.
  bool load_targets(const Eigen::Ref<const Eigen::VectorXd>& positions);

  /// Sends the controlwords and modes of these axes without set-points, for axes whose motions
  /// taktd runs. Returns false if LCM did not take the message.
  bool send_controls(std::span<const AxisControl::Index> axes);
  /// Sends a command for motions that taktd runs, in the name of this group and from its newest
  /// image. The caller fills in `id`, `kind`, `synchronisation`, `timeout_ms` and `goals`; the call
  /// fills in the rest. Returns false if LCM did not take the message. Axes (`<takt/motion.hpp>`)
  /// calls this function.
  bool send_motion(motion_command_t& command);
  /// Sends a gear in the same way. The caller fills in the leader, the ratios, `id`, `phase`,
  /// `timeout_ms` and `goals`.
  bool send_gear(motion_gear_t& gear);
  /// Sends points of a stream in the same way. The caller fills in `id`, `timeout_ms`, `goals`,
  /// `first_point` and `points`.
  bool send_stream(motion_stream_t& stream);

  /// Sends these values of outputs, in the name of this group and from its newest image. The caller
  /// fills in `signals` and `values`. Returns false if LCM did not take the message. Axes
  /// (`<takt/motion.hpp>`) calls this function for speed axes.
  bool send_values(command_t& command);

  /// Sends a request for a service of taktd, for example "sdo_upload", in the name of this group.
  /// The caller fills in `id`, `service` and what the service needs; the call fills in the rest. A
  /// request that is sent again with the same `utime` is served once. Returns false if LCM did not
  /// take the message.
  bool send_request(request_t& request);
  /// Returns the answers to requests of this group that have come since the last call.
  std::vector<reply_t> take_replies();

  /// Returns the axes, which wait() keeps up to date. There are none before the first layout.
  AxisControl& axes() noexcept;
  /// Returns the axes, which wait() keeps up to date. There are none before the first layout.
  const AxisControl& axes() const noexcept;
  /// Returns the layout and the newest image.
  const ImageInput& input() const noexcept;
  /// Returns the program that commands the node of this axis, as the newest status_t of taktd shows
  /// it. taktd refuses the commands of all other programs for this node. send() does not check
  /// this, so each application decides for how many status_t another program may hold a node before
  /// the application gives up.
  const NodeHolder& holder(AxisControl::Index axis) const;
  /// Returns the holder of the node with this node-ID, 1..127.
  const NodeHolder& holder_of_node(std::int16_t node) const;
  /// Returns the speed axes of the layout, by their node-IDs. Empty if the bus has none.
  const std::vector<speed_axis_t>& speed_axes() const noexcept;
  /// Returns what taktd has reported last about the motion of this axis; its positions are in the
  /// unit of the target position. Empty if this run of taktd has reported none: taktd reports
  /// motions from the first command for motions on.
  std::optional<axis_motion_t> motion(AxisControl::Index axis) const;
  /// Returns the cycle of what motion() returns for this axis, or -1.
  std::int64_t motion_cycle(AxisControl::Index axis) const;
  /// Returns the newest status of the node of this axis. Empty before the first status_t.
  std::optional<node_status_t> node_status(AxisControl::Index axis) const;
  /// Returns the newest status of the node with this node-ID. Empty before the first status_t.
  std::optional<node_status_t> status_of_node(std::int16_t node) const;
  /// Returns the name of this sender in events and in status_t: the name of the options and eight
  /// hex digits of the instance. The digits distinguish two running programs with the same name.
  const std::string& sender() const noexcept;
  /// Returns the name of the bus. Empty if none was configured and no layout has arrived.
  const std::string& bus() const noexcept;
  /// Returns the period of SYNC. 0 means that no layout has arrived yet.
  std::chrono::nanoseconds period() const noexcept;
  /// Returns the time since wait() took the newest image, by the monotonic clock of this machine.
  /// The value means nothing before the first image.
  std::chrono::nanoseconds age() const;
  /// Returns the events of taktd since the last call (boots, refused commands, faults), at most
  /// 256. The library itself adds one event `other_schema` if taktd speaks another schema of the
  /// messages.
  std::vector<event_t> take_events();

 private:
  class State;
  std::unique_ptr<State> state_;
};

}  // namespace takt
