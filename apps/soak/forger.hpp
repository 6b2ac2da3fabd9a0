#pragma once
#include <cstdint>
#include <deque>
#include <vector>

#include "apps/simulate/stage.hpp"
#include "apps/simulate/virtual_lcm.hpp"
#include "apps/soak/wire_judge.hpp"
#include "master/gateway/bridge.hpp"
#include "master/sim/random.hpp"

namespace takt {

/// A program that hears everything and sends what nobody may obey: messages of before once more,
/// commands from no cycle, from the future or of another session, images of a cycle that will
/// never be, and bytes without sense.
class Forger final : public Actor {
 public:
  Forger(const BusPlan& plan, VirtualLcm& lcm, WireJudge& judge, sim::Random random);

  void act_up(Time now);
  /// A replay: some of what was heard comes again, from `cycle 0` or as it was.
  void replay(Time now);
  std::uint64_t sent() const noexcept { return sent_; }

  Time next() const noexcept override { return lcm_.next_arrival(); }
  void act(Time now) override;

 private:
  struct Heard {
    Time when{};
    std::vector<std::byte> command;
  };
  void forge_command();
  void forge_image();
  void send_rubbish();
  void publish(const std::string& channel, std::span<const std::byte> data);

  const BusPlan& plan_;
  WireJudge& judge_;
  sim::Random random_;
  VirtualEndpoint& lcm_;
  Channels channels_;
  std::deque<Heard> heard_;
  std::vector<std::byte> image_;  // the newest
  std::vector<std::byte> buffer_;
  std::uint64_t sent_ = 0;
};

}  // namespace takt
