#pragma once
#include <cstdint>
#include <deque>
#include <functional>
#include <optional>
#include <utility>
#include <vector>

#include "apps/simulate/stage.hpp"
#include "apps/simulate/virtual_lcm.hpp"
#include "master/gateway/bridge.hpp"
#include "master/sim/random.hpp"

namespace takt {

/// A program that hears everything and sends what nobody may obey: old messages once more, commands
/// from no cycle, from the future or of another session, images of a cycle that has not come, and
/// bytes without sense. It learns from genuine messages only, and a cycle that it forges is always
/// far from the true one.
class Forger final : public Actor {
 public:
  /// `forged` hears each position that nobody may ever see on the wire.
  using Forged = std::function<void(SignalIndex signal, std::int64_t value)>;

  Forger(const BusPlan& plan, VirtualLcm& lcm, Forged forged, sim::Random random);

  /// One of the following, by chance.
  void act_up(Time now);
  /// A replay: some of what was heard comes again, from `cycle 0` or as it was.
  void replay(Time now);
  /// The newest command with another position, which nobody obeys for one of several reasons.
  void forge_command(Time now);
  /// An image of the far future.
  void forge_image(Time now);
  /// Bytes of any length, or a command that is cut off, on any channel.
  void send_rubbish();
  std::uint64_t sent() const noexcept { return sent_; }

  Time next() const noexcept override { return lcm_.next_arrival(); }
  void act(Time now) override;

 private:
  struct Heard {
    Time when{};
    std::vector<std::byte> command;
  };
  void publish(const std::string& channel, std::span<const std::byte> data);
  std::optional<std::int64_t> cycle_at(Time now) const;
  std::int64_t far_away() const noexcept;

  const BusPlan& plan_;
  Forged forged_;
  sim::Random random_;
  VirtualEndpoint& lcm_;
  Channels channels_;
  std::deque<Heard> heard_;
  std::vector<std::byte> image_;  // the newest
  std::vector<std::byte> buffer_;
  std::uint64_t sent_ = 0;
};

}  // namespace takt
