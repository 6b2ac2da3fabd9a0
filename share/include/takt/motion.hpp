#pragma once
/// @file
/// Motions of CiA 402 axes that taktd runs: enable, move, jog, gear, stream, stop. The bus thread
/// of taktd gives the drives their set-points, so the program may be late. The same calls work for
/// inverters, as axes with a speed and without a position.
#include <Eigen/Core>
#include <chrono>
#include <concepts>
#include <cstddef>
#include <cstdint>
#include <expected>
#include <functional>
#include <memory>
#include <span>
#include <string>
#include <takt/axis.hpp>
#include <takt/drive402.hpp>
#include <takt/lcm.hpp>
#include <vector>

namespace takt {

/// The reason why a call of Axes has failed.
struct Obstacle {
  /// Kinds of obstacles.
  enum class Kind : std::uint8_t {
    wrong_use,  ///< An axis is unknown, or the number of values does not fit.
    no_bus,     ///< LCM can't be opened, or no image of the bus comes.
    blocked,    ///< A drive, its device or another program prevents the call, or still did when the
                ///< time was over.
    refused,    ///< taktd has refused the motion, or has not answered it for 2 s.
    stopped,    ///< The motion or the homing has ended before its target.
    time_over,  ///< The axes still move, home or are enabled, or no newer image has come.
    restarted,  ///< taktd has restarted. Only a new Axes can command its axes.
    interrupted,  ///< AxesOptions::interrupted has returned true.
  };
  Kind kind = Kind::blocked;  ///< what kind of obstacle this is
  std::string text;           ///< a sentence for the user, which names the axis and what blocks it
};

/// The result of a call of Axes: success without a value, or the obstacle.
using Done = std::expected<void, Obstacle>;

/// Options of Axes.
struct AxesOptions {
  /// Name of the bus in the network file. Empty selects the first bus whose layout arrives.
  std::string bus = {};
  /// Names of the axes, in the order of all vectors: names of nodes, or "gantry.2" for the second
  /// axis of a device. Empty selects all axes of the bus, in the order of their node-IDs.
  std::vector<std::string> names = {};
  /// Name of the program in events and in status_t.
  std::string sender = "axes";
  /// Address of LCM, as for open_lcm().
  std::string lcm_url = {};
  /// Longest time of each call, with these exceptions: move(), move_by() and wait() last as long as
  /// their motions, run() lasts for the time of its argument, and jog() waits for the answer of
  /// taktd for 2 s at most.
  std::chrono::nanoseconds longest = std::chrono::seconds{10};
  /// The motions stop along their limits if this program is silent for this time, 1 ms to 10 s.
  std::chrono::milliseconds timeout{500};
  /// Calls that wait call this function again and again, and end with Obstacle::Kind::interrupted
  /// if it returns true. stop() and disable() do not call it. If it is empty, nothing interrupts
  /// the calls.
  std::function<bool()> interrupted = {};
};

/// Limits of a motion, in the unit of each axis and in seconds. Each vector has one value for each
/// axis, or one for all axes, or none. Without a value, or with 0, the `limits:` of the network
/// file apply; taktd refuses values that are larger than these.
struct MotionBounds {
  Eigen::VectorXd velocity = {};      ///< unit/s
  Eigen::VectorXd acceleration = {};  ///< unit/s^2
  Eigen::VectorXd jerk = {};          ///< unit/s^3
  /// Unit; the axes stop above this following error. Empty or 0: the error is not monitored.
  Eigen::VectorXd following_error = {};
};

/// A state of the axes at one time of a stream. See Axes::stream(). Vectors have one value for each
/// axis, in its unit.
struct PathPoint {
  double time = 0.0;             ///< s since the start of the stream; rises from point to point
  Eigen::VectorXd position;      ///< unit
  Eigen::VectorXd velocity;      ///< unit/s
  Eigen::VectorXd acceleration;  ///< unit/s^2. Empty: the curve to this point is cubic
};

/// A leader that axes follow, and the way in which they follow it. See Axes::gear(). Vectors have
/// one value for each axis, or one for all axes.
struct Gear {
  /// Name of the axis whose commanded position the axes follow, as in AxesOptions::names. If
  /// `signal` is set, this is the name of a node instead.
  std::string leader = {};
  /// Name of an input of this node. If it is set, the axes follow the input instead of a commanded
  /// position: "position_value" of an encoder (0x6004), "position_actual_value" of a drive.
  std::string signal = {};
  /// Units of the axis per unit of the leader. Negative: the axis turns the other way. Empty: 1.
  Eigen::VectorXd ratio = {};
  /// The positions become ratio * position of the leader + phase. Empty: only the velocities are
  /// matched, and each axis keeps the phase that it has when they are.
  Eigen::VectorXd phase = {};
  /// Value at which the signal begins again, in its unit. 0: it only wraps with its number of bits.
  double modulo = 0.0;
  /// Time constant of the estimate of the velocity of a signal. 0: 20 ms.
  std::chrono::nanoseconds filter_time{0};
  /// The axes stop if their phase error exceeds this value after they were locked. Empty or 0: they
  /// do not stop, but fall behind and catch up.
  Eigen::VectorXd max_phase_error = {};
};

/// Limits of Axes::profile_move(), which the drives keep, in the unit of each axis and in seconds.
/// Each vector has one value for each axis, or one for all axes, or is empty; the drive then keeps
/// the values that it has.
struct ProfileBounds {
  Eigen::VectorXd velocity = {};      ///< unit/s, 0x6081
  Eigen::VectorXd acceleration = {};  ///< unit/s^2, 0x6083
  Eigen::VectorXd deceleration = {};  ///< unit/s^2, 0x6084. Empty: as the acceleration
};

/// How Axes::profile_move() moves.
struct ProfileMove {
  /// If true, the values are distances from the newest targets, or from the actual positions after
  /// a stop. The drives get absolute positions, so that taktd can check them.
  bool relative = false;
  SetPointTiming timing = SetPointTiming::immediately;  ///< when the drives begin
  bool wait = true;  ///< false: the call returns when the drives have taken the targets
};

/// Options of Axes::touch_probe().
struct ProbeOptions {
  /// The change of the input at which the drive stores the position.
  enum class Edge : std::uint8_t {
    rising,   ///< from inactive to active
    falling,  ///< from active to inactive
  };
  /// The signal whose edge the probe detects.
  enum class Source : std::uint8_t {
    input,        ///< the input of the probe
    index_pulse,  ///< the index pulse of the encoder
  };
  int input = 1;                  ///< number of the touch probe, 1 or 2
  Edge edge = Edge::rising;       ///< which edge stores the position
  Source source = Source::input;  ///< where the edge comes from
  std::chrono::nanoseconds longest = std::chrono::seconds{10};  ///< longest wait for the edge
};

/// Options of Axes::home().
struct HomingOptions {
  /// In which order the axes are homed.
  enum class Order : std::uint8_t {
    one_after_the_other,  ///< In the order of their names. The first obstacle ends it.
    together,             ///< All at once. If one of them fails, the others stop, too.
  };
  Order order = Order::one_after_the_other;  ///< in which order the axes are homed
  /// Longest time of a homing run. 0 selects the time of `homing: {timeout: ...}` in the network
  /// file, or 60 s if the file has none.
  std::chrono::nanoseconds longest{0};
};

/// Axes of one bus whose motions taktd runs. Each call returns when it has done its work, or
/// returns an obstacle with a sentence about what blocks it.
///
/// While a call waits, it sends signs of life of this program to taktd. Between calls, the motions
/// continue for AxesOptions::timeout, and the drives stay enabled. After this time, the motions
/// stop along their limits, and the drives take the fallback of `on_timeout` in the network file. A
/// program that has nothing to do calls run() instead of sleeping.
///
/// **Speed axes** are CiA 402 drives with 0x6042, and inverters. The device data of takt or
/// `speed_axis` of the network file describe the control word and the status word of an inverter.
/// All axes of an object are of one kind. If AxesOptions::names is empty, they are the axes with
/// positions if there are any. taktd runs no motions of speed axes: this program computes their
/// words from each image, and the drives run along their own ramps. Each call sends words. If the
/// program is silent for AxesOptions::timeout, or for the time in `on_timeout`, the drives stop
/// along their ramps. A jog that was stopped in this way does not begin again by itself. Calls that
/// need a position are refused.
///
/// The axes of one call begin in the same cycle, and a stop of one stops all of them. Vectors have
/// one element for each axis, in its unit (rad, m, or raw counts if the layout states no unit). All
/// calls come from one thread. A moved-from object may only be destroyed or assigned to.
class Axes {
 public:
  /// Opens LCM, waits until the first image of the bus has come, and finds the axes.
  static std::expected<Axes, Obstacle> open(AxesOptions options);
  /// Does the same with a transport that is already open, and with a key, which is necessary if
  /// `keys` is configured for taktd.
  static std::expected<Axes, Obstacle> open(std::unique_ptr<Transport> lcm, AxesOptions options,
                                            const EnvelopeKey* key = nullptr);
  /// Calls disable(), which does nothing if this object commands no drive.
  ~Axes();
  /// Moves the object.
  Axes(Axes&& other) noexcept;
  /// Moves the object.
  Axes& operator=(Axes&& other) noexcept;

  /// Brings all axes to Operation enabled and cyclic synchronous position mode, and waits until
  /// taktd reports their motions. A fault is an obstacle: see reset().
  Done enable();
  /// Stops the axes, brings them to Switch on disabled, and releases their nodes.
  Done disable();
  /// Resets the faults of all axes.
  Done reset();
  /// Sets another mode of operation for all axes, and waits until the drives show it. Motions need
  /// cyclic synchronous position mode, which enable() sets again. The call stops the axes first. No
  /// mode begins with a jump: target positions follow the actual ones, and target velocities and
  /// torques begin at 0.
  Done set_mode(DriveMode mode);
  /// Sets another mode for one axis, 0..size()-1, in the same way. The call stops all axes first.
  Done set_mode(Eigen::Index axis, DriveMode mode);

  /// Sets the Halt bit (bit 8 of 0x6040) of all axes, and waits until the axes are at standstill.
  /// taktd also ends their motions along their limits, because many drives ignore the bit in cyclic
  /// synchronous modes. No motion begins before resume() or enable(). CiA 402-2, controlword.
  Done halt();
  /// Ends the Halt. The axes stay at standstill until the next motion or set-point, but a drive in
  /// profile position mode goes on to its target.
  Done resume();
  /// Commands a quick stop (bit 2 of 0x6040 is 0): the drives brake by themselves, along 0x6085.
  /// Waits until the drives show the quick stop and the axes are at standstill. The drives are then
  /// not enabled, see enable().
  Done quick_stop();

  /// Lets the drives move to these positions by themselves, in profile position mode: see
  /// set_mode(). Waits until bit 10 of each statusword shows that the target is reached. The call
  /// writes the bounds to 0x6081, 0x6083 and 0x6084, and the drives keep them; taktd checks the
  /// range of positions, but no velocity. If this program is silent for AxesOptions::timeout, or
  /// for the time in `on_timeout`, the drives take their fallback. CiA 402-2, profile position
  /// mode.
  Done profile_move(const Eigen::Ref<const Eigen::VectorXd>& positions,
                    const ProfileBounds& bounds = {}, const ProfileMove& how = {});
  /// Sets the target velocities (0x60FF), in profile or cyclic synchronous velocity mode. Returns
  /// when an image shows that they were sent. The drives keep these velocities until the next call,
  /// until stop(), or until this program is silent as described at set(). After a silence, the
  /// velocities do not begin again by themselves.
  Done command_velocities(const Eigen::Ref<const Eigen::VectorXd>& velocities);
  /// Sets the target torques (0x6071), in profile or cyclic torque mode, in the same way. With the
  /// torque 0, which stop() sets, an axis coasts, and a load may move it.
  Done command_torques(const Eigen::Ref<const Eigen::VectorXd>& torques);

  /// Arms a touch probe of an axis (0..size()-1), waits for its edge, and returns the position that
  /// the drive has stored with it, in the unit of the axis. Motions go on during the call: begin a
  /// motion before, and stop it afterwards. The call uses PDOs for the objects that are mapped, and
  /// SDO for the others. CiA 402-2, 0x60B8 to 0x60BD.
  std::expected<double, Obstacle> touch_probe(Eigen::Index axis, const ProbeOptions& options = {});

  /// Reads an object of at most 1024 bytes by SDO, as little-endian bytes. taktd makes the
  /// transfer, and motions go on. If the device aborts the transfer, the obstacle gives the meaning
  /// of the abort code. CiA 301, SDO.
  std::expected<std::vector<std::uint8_t>, Obstacle> read(const std::string& node,
                                                          std::uint16_t index,
                                                          std::uint8_t sub = 0);
  /// Writes an object of a node by SDO. The number of bytes has to be that of the object.
  Done write(const std::string& node, std::uint16_t index, std::uint8_t sub,
             std::span<const std::uint8_t> data);
  /// Reads an object that is an integer of this type.
  template <std::integral Number>
  std::expected<Number, Obstacle> read_number(const std::string& node, std::uint16_t index,
                                              std::uint8_t sub = 0) {
    const auto bits = read_bits(node, index, sub, sizeof(Number));
    if (!bits) return std::unexpected{bits.error()};
    return static_cast<Number>(*bits);
  }
  /// Writes an object that is an integer of this type.
  template <std::integral Number>
  Done write_number(const std::string& node, std::uint16_t index, std::uint8_t sub, Number value) {
    return write_bits(node, index, sub, static_cast<std::uint64_t>(value), sizeof(Number));
  }
  /// Returns a value of the newest image in its unit: "io.NAME" is the input or output NAME of node
  /// "io", as in layout_t, and "io.0x6000:1" is the value of this object.
  std::expected<double, Obstacle> signal(const std::string& name);
  /// Sets an output of a node in its unit. Outputs with which an axis is commanded are refused.
  /// Returns when an image shows that it was sent. The value is held until the next set(), until
  /// disable(), or until this program is silent for AxesOptions::timeout or for the time in
  /// `on_timeout`. After a silence, the output takes its fallback, and run() returns an obstacle. A
  /// device gets an RPDO only when each of its outputs has a value.
  Done set(const std::string& name, double value);

  /// Homes the axes: enables them if they are not enabled, sets homing mode (0x6060 = 6), starts
  /// the method that the drive has (0x6098, `homing:` of the network file), and waits for the
  /// result. Then, also after an obstacle, it ends the run, waits for standstill, and sets cyclic
  /// synchronous position mode again, with the targets at the actual positions. The positions of
  /// the axes jump: after success they count from home. If this program dies meanwhile, the drives
  /// take the fallback of `on_timeout`. CiA 402-2, homing mode.
  Done home(const HomingOptions& options = {});

  /// Moves the axes to these positions, and waits until the commanded positions are there and at
  /// rest. The actual positions differ by the following errors.
  Done move(const Eigen::Ref<const Eigen::VectorXd>& positions, const MotionBounds& bounds = {});
  /// Moves as move() does, but by distances from the commanded positions in the cycle in which the
  /// move begins.
  Done move_by(const Eigen::Ref<const Eigen::VectorXd>& distances, const MotionBounds& bounds = {});
  /// Begins a move and returns at once. A new target is possible during a motion. See wait().
  Done begin_move(const Eigen::Ref<const Eigen::VectorXd>& positions,
                  const MotionBounds& bounds = {});
  /// Brings the axes to these velocities, and returns when taktd has begun. The axes keep the
  /// velocities until stop(), until the end of their range, or until this program is silent. If the
  /// call fails, it stops the axes. A speed axis takes the velocity in its unit, and only the
  /// acceleration of the bounds. Without this acceleration, the limit of the network file applies;
  /// without both, the drive follows its own ramps.
  Done jog(const Eigen::Ref<const Eigen::VectorXd>& velocities, const MotionBounds& bounds = {});
  /// Begins to follow a leader, and returns when taktd has begun. The axes approach the motion of
  /// the leader within their limits, and follow it until stop(), until another motion begins, or
  /// until this program is silent. move() takes over without a stop. See wait_locked().
  Done gear(const Gear& gear, const MotionBounds& bounds = {});
  /// Prepares a stream: a path of points that this program computes in advance. The axes must be
  /// at rest, and nothing moves yet.
  Done begin_stream(const MotionBounds& bounds = {});
  /// Gives further points of the stream. They are sent about 0.4 s, and at most 60 points, before
  /// the axes reach them; the call returns when there is room for more. The axes begin to move when
  /// the room is full, or when wait() is called. A point at time 0 has to be the position at which
  /// the axes are at rest; without such a point, the stream begins at their commanded position. Two
  /// points are 4 s apart at most. taktd checks the whole path against the bounds, the range and
  /// the possibility of a stop. If the call fails, it stops the axes.
  ///
  /// wait() returns when the axes are at rest at the last point. If the points end while the axes
  /// move, or if this program is silent, the axes stop along their limits, and the next call
  /// reports this.
  Done stream(std::span<const PathPoint> points);
  /// Returns the seconds until the axes reach the newest point that the bus thread of taktd has, as
  /// taktd has reported last. 0 if no stream runs.
  double stream_left() const;
  /// Waits until all axes have the positions that their gears prescribe.
  Done wait_locked(std::chrono::nanoseconds longest);
  /// Stops the axes along their limits, and waits until they are at standstill.
  Done stop();
  /// Waits until the newest motion has ended. If `longest` is over before, the motion goes on.
  Done wait(std::chrono::nanoseconds longest = std::chrono::nanoseconds::max());
  /// Waits for this time, in which motions go on.
  Done run(std::chrono::nanoseconds time);

  /// Returns the number of axes.
  Eigen::Index size() const noexcept;
  /// Returns the name of an axis, 0..size()-1.
  const std::string& name(Eigen::Index axis) const;
  /// Returns false if these are speed axes, whose positions are 0.
  bool has_positions() const noexcept;
  /// Returns the unit of the positions of an axis, or of the speeds of a speed axis ("rpm", "Hz").
  /// An empty text means raw counts.
  const std::string& unit(Eigen::Index axis) const;
  /// Returns true if a homing run of this axis has succeeded since its node began to exchange PDOs,
  /// as taktd has reported last.
  bool homed(Eigen::Index axis) const;
  /// Returns true if taktd refuses to move this axis to positions until it is homed: `homing:` of
  /// the network file requires it.
  bool needs_homing(Eigen::Index axis) const;
  /// Returns true if at least one axis moves or stops, as taktd has reported last. taktd reports
  /// this only in cyclic synchronous position mode.
  bool moving() const;
  /// Returns the actual positions (0x6064) of the newest image. All values of this object are 0
  /// once taktd has restarted.
  Eigen::VectorXd positions() const;
  /// Returns the actual velocities (0x606C) of the newest image; 0 for an axis whose 0x606C no PDO
  /// carries.
  Eigen::VectorXd velocities() const;
  /// Returns the commanded positions, as taktd has reported last; before that, the actual ones.
  Eigen::VectorXd commanded_positions() const;
  /// Returns the following errors, commanded minus actual position, as taktd has reported last.
  Eigen::VectorXd following_errors() const;
  /// Returns true if the gears of all axes are locked, as taktd has reported last.
  bool locked() const;
  /// Returns how far each axis is ahead of the position that its gear prescribes.
  Eigen::VectorXd phase_errors() const;
  /// Returns the AxisGroup that this object uses. It has the image, the events, and the states of
  /// the drives.
  AxisGroup& group() noexcept;

 private:
  class State;
  explicit Axes(std::unique_ptr<State> state);
  std::expected<std::uint64_t, Obstacle> read_bits(const std::string& node, std::uint16_t index,
                                                   std::uint8_t sub, std::size_t bytes);
  Done write_bits(const std::string& node, std::uint16_t index, std::uint8_t sub,
                  std::uint64_t bits, std::size_t bytes);
  std::unique_ptr<State> state_;
};

}  // namespace takt
