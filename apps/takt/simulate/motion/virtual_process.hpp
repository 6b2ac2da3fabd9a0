#pragma once
#include <condition_variable>
#include <cstdint>
#include <functional>
#include <memory>
#include <mutex>
#include <takt/lcm.hpp>
#include <thread>

#include "apps/axis/group/surroundings.hpp"
#include "apps/takt/simulate/program/stage.hpp"
#include "apps/takt/simulate/program/virtual_lcm.hpp"
#include "master/lcm/clocks.hpp"
#include "master/sim/random.hpp"

namespace takt {

/// A program in virtual time whose code may wait, as that of a real program does. It runs on its
/// own thread, and only while act() waits for it. Therefore equal seeds give equal runs.
class VirtualProcess final : public Actor, private Surroundings {
 public:
  VirtualProcess(VirtualLcm& lcm, const Clocks& clocks, sim::Random random);
  ~VirtualProcess() override { kill(); }
  VirtualProcess(const VirtualProcess&) = delete;
  VirtualProcess& operator=(const VirtualProcess&) = delete;

  /// Starts the program: `work` runs on its thread, with the first act().
  void start(std::function<void()> work);
  /// Ends the program. From then on, the program sends and receives nothing. Time passes for the
  /// program until its code has returned.
  void kill();
  /// Returns true from kill() on. The code of the program calls this.
  bool is_killed() const noexcept { return killed_; }
  /// Returns the connection of the program to LCM, which must not outlive `work`.
  std::unique_ptr<Transport> connect();

  Time next() const noexcept override;
  void act(Time now) override;

 private:
  class Connection;
  /// The thread that runs now.
  enum class Turn : std::uint8_t { simulation, program };
  void await(Turn turn);
  void pass_to(Turn turn);
  std::chrono::nanoseconds now() override { return clocks_.now() + after_death_; }
  std::chrono::nanoseconds wall() override { return now() + clocks_.wall_offset(); }
  void wait(std::span<pollfd> descriptors, std::chrono::nanoseconds longest) override;
  std::int64_t random_number() override;

  VirtualEndpoint& lcm_;
  const Clocks& clocks_;
  sim::Random random_;
  std::function<void()> work_;
  std::thread thread_;
  std::mutex mutex_;
  std::condition_variable changed_;
  Turn turn_ = Turn::simulation;
  bool ended_ = false;
  bool killed_ = false;
  Time wake_ = never;
  Time reaction_{};     // time from the arrival of a message until the program sees it
  Time after_death_{};  // time that has passed for the program since kill()
};

}  // namespace takt
