#pragma once
#include <array>
#include <cstdint>
#include <deque>
#include <functional>
#include <optional>
#include <vector>

#include "apps/takt/simulate/program/stage.hpp"
#include "apps/takt/simulate/program/virtual_lcm.hpp"
#include "master/gateway/bridge.hpp"
#include "master/sim/random.hpp"

namespace takt {

/// A program that receives every message and sends messages that must have no effect: old messages
/// once more, commands and motions computed from no cycle, from a future cycle or for another
/// session, images of a future cycle, and random bytes. The forger learns only from genuine
/// messages, and a forged cycle is always far from the true one.
class Forger final : public Actor {
 public:
  /// Called with each forged position, which must never appear on the wire.
  using Forged = std::function<void(SignalIndex signal, std::int64_t value)>;

  Forger(const BusPlan& plan, VirtualLcm& lcm, Forged forged, sim::Random random);

  /// Performs one of the actions below, chosen at random.
  void act_up(Time now);
  /// Sends some of the recorded commands again, unchanged or with cycle 0.
  void replay(Time now);
  /// Sends the newest command with other positions and with a wrong cycle or session.
  void forge_command(Time now);
  /// Sends an image of a cycle in the far future.
  void forge_image(Time now);
  /// Sends random bytes of random length, or a truncated command, on a random channel.
  void send_random_bytes();
  std::uint64_t sent() const noexcept { return sent_; }

  Time next() const noexcept override { return lcm_.next_arrival(); }
  void act(Time now) override;

 private:
  struct Heard {
    Time when{};
    std::vector<std::byte> command;
  };
  /// `Message` is motion_command_t or motion_gear_t, which was heard on `channel`.
  template <class Message>
  void forge_motion(const std::deque<Heard>& heard, const std::string& channel, Time now);
  template <class Message>
  void replay_motions(const std::deque<Heard>& heard, const std::string& channel, Time now);
  std::array<std::int64_t, 6> wrong_cycles(std::int64_t cycle);
  void publish(const std::string& channel, std::span<const std::byte> data);
  std::optional<std::int64_t> cycle_at(Time now) const;
  std::int64_t far_away() const noexcept;

  const BusPlan& plan_;
  Forged forged_;
  sim::Random random_;
  VirtualEndpoint& lcm_;
  Channels channels_;
  std::deque<Heard> heard_;
  std::deque<Heard> motions_;
  std::deque<Heard> gears_;
  std::vector<std::byte> image_;  // newest genuine image, encoded
  std::vector<std::byte> buffer_;
  std::uint64_t sent_ = 0;
};

}  // namespace takt
