#pragma once
#include <cstdint>
#include <functional>
#include <optional>
#include <string>
#include <vector>

#include "apps/axis/axis_control.hpp"
#include "apps/axis/image_input.hpp"
#include "apps/simulate/stage.hpp"
#include "apps/simulate/virtual_lcm.hpp"
#include "master/gateway/bridge.hpp"
#include "master/sim/random.hpp"

namespace takt {

struct ApplicationOptions {
  std::string name;         ///< as its commands say it
  unsigned number = 0;      ///< 0..7, of this program
  std::vector<bool> nodes;  ///< that it commands, in the order of BusPlan::nodes

  /// Hears each command when it is sent, and the SYNC of the image that it was computed from.
  std::function<void(const command_t& command, Time computed_from)> commanded{};
  /// It gives up its outputs.
  std::function<void(Time now)> released{};
  /// It has heard images for a long time, and could use none.
  std::function<void(const std::string& what)> deaf{};
  /// For tests: the instance that it gives itself, `own` being its random one.
  std::function<std::int64_t(std::int64_t own)> instance{};
  /// For tests: false where it does not look at this image.
  std::function<bool(const image_t& image)> hears{};
};

/// A program that moves axes, made of the axis library: it takes the newest image and sends one
/// command. It counts its positions up, and down again where a limit is near, so that each value on
/// the wire shows who has sent it and when. Where a drive has target velocities and torques too,
/// they rise and fall slowly.
class VirtualApplication final : public Actor {
 public:
  VirtualApplication(const BusPlan& plan, VirtualLcm& lcm, ApplicationOptions options,
                     sim::Random random);

  /// A new process.
  void start();
  void kill();
  /// Ends in order: gives up its outputs first.
  void end(Time now);
  /// The set-points of its next command lie this many counts away from where they should be: target
  /// velocities and torques of the drives that have them, positions of the others.
  void jump(std::int64_t counts) noexcept { jump_ = counts; }
  void stall(Time until) noexcept { stalled_until_ = std::max(stalled_until_, until); }
  bool runs() const noexcept { return running_; }
  const std::string& name() const noexcept { return options_.name; }
  unsigned number() const noexcept { return options_.number; }
  const std::vector<bool>& nodes() const noexcept { return options_.nodes; }
  bool commands(std::size_t node_index) const { return options_.nodes[node_index]; }
  /// From now on it needs so long for each image.
  void slow_down(Time reaction) noexcept { slowness_ = reaction; }
  /// Axes that it leads at this moment.
  std::size_t leads() const noexcept;
  std::uint64_t images() const noexcept { return images_; }  ///< that it has used
  std::uint64_t sent() const noexcept { return sent_; }      ///< commands
  std::uint64_t dropped() const noexcept { return lcm_.dropped(); }

  /// Which one it is, and how its axes are.
  std::string text() const;

  Time next() const noexcept override;
  void act(Time now) override;

 private:
  void take(std::string_view channel, std::span<const std::byte> data);
  void follow_image();
  void send(Time now);
  void keep_own_outputs(command_t& command) const;
  void count_on(command_t& command);
  std::int64_t next_position(AxisControl::Index axis, std::int64_t from);
  void push(AxisControl::Index axis, command_t& command);
  bool has_push(AxisControl::Index axis) const;
  void judge_hearing(Time now);

  const BusPlan& plan_;
  ApplicationOptions options_;
  sim::Random random_;
  VirtualEndpoint& lcm_;
  Channels channels_;
  bool running_ = false;
  Time stalled_until_{};
  Time reaction_{};
  Time slowness_{};
  std::int64_t instance_ = 0;
  std::uint32_t time_to_live_ = 20;
  ImageInput input_;
  AxisControl axes_;
  bool new_layout_ = false;
  bool fresh_ = false;
  Time sync_{};  // of the newest image
  struct Course {
    std::optional<std::int64_t> position;  // as it was commanded last; none: not enabled
    bool down = false;
    std::int64_t push = 0;   // of target torques; target velocities are a multiple
    bool weaker = false;     // `push` falls
    std::int64_t apart = 0;  // counts by which target velocity and torque have jumped
  };
  std::vector<Course> courses_;  // of each axis
  std::int64_t jump_ = 0;        // of the next command
  std::uint64_t images_ = 0;     // used
  bool hears_ = false;           // an image came in this round
  std::uint64_t heard_ = 0;      // rounds with images since the last one that it could use
  Time heard_since_{};
  std::uint64_t sent_ = 0;
  std::vector<std::byte> buffer_;
};

}  // namespace takt
