#pragma once
#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "apps/axis/axis_control.hpp"
#include "apps/axis/image_input.hpp"
#include "apps/simulate/stage.hpp"
#include "apps/simulate/virtual_lcm.hpp"
#include "apps/soak/front_meddle.hpp"
#include "apps/soak/verdict.hpp"
#include "apps/soak/wire_judge.hpp"
#include "master/gateway/bridge.hpp"
#include "master/sim/random.hpp"

namespace takt {

struct ApplicationOptions {
  std::string name;         ///< as its commands say it
  unsigned number = 0;      ///< 0..7, of this program
  std::vector<bool> nodes;  ///< that it commands, in the order of BusPlan::nodes
  const FrontMeddle* meddle = nullptr;
};

/// A program that moves axes, made of the axis library: the newest image in, one command out. It
/// counts its positions up, and down again where a limit is near, so that each value on the wire
/// tells who has sent it and when.
class VirtualApplication final : public Actor {
 public:
  VirtualApplication(const BusPlan& plan, VirtualLcm& lcm, WireJudge& judge, Verdict& verdict,
                     ApplicationOptions options, sim::Random random);

  /// A new process.
  void start();
  void kill();
  /// Ends in order: gives up its outputs first.
  void end(Time now);
  /// Its next positions lie so many counts away from where they should.
  void jump(std::int64_t counts) noexcept { jump_ = counts; }
  void stall(Time until) noexcept { stalled_until_ = std::max(stalled_until_, until); }
  bool runs() const noexcept { return running_; }
  SenderBit bit() const noexcept { return 1U << options_.number; }
  const std::vector<bool>& nodes() const noexcept { return options_.nodes; }
  bool commands(std::size_t node_index) const { return options_.nodes[node_index]; }
  std::uint64_t sent() const noexcept { return sent_; }

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
  void judge_hearing(Time now);

  const BusPlan& plan_;
  WireJudge& judge_;
  Verdict& verdict_;
  ApplicationOptions options_;
  sim::Random random_;
  VirtualEndpoint& lcm_;
  Channels channels_;
  bool running_ = false;
  Time stalled_until_{};
  Time reaction_{};
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
  };
  std::vector<Course> courses_;  // of each axis
  std::int64_t jump_ = 0;
  std::uint64_t images_ = 0;  // used
  std::uint64_t heard_ = 0;   // images since the last one that it could use
  Time heard_since_ = never;
  std::uint64_t sent_ = 0;
  std::vector<std::byte> buffer_;
};

}  // namespace takt
