#pragma once
#include <functional>
#include <memory>
#include <optional>
#include <string>
#include <takt/motion.hpp>
#include <vector>

#include "apps/takt/soak/judge/homing_judge.hpp"
#include "master/sim/random.hpp"

namespace takt::soak {

/// The code of a program that homes its axes and moves them at random, for the thread of a
/// VirtualProcess.
class HomingProgram {
 public:
  /// The largest velocity that it commands, in the unit of each axis per second.
  static constexpr double velocity = 3.0;

  struct Setting {
    std::string bus;
    std::vector<std::string> axes;
    std::vector<std::size_t> numbers;  ///< numbers of the axes for the judge
    std::function<std::unique_ptr<Transport>()> connect;
    std::function<bool()> is_killed;
    /// Called with the name of each call that begins, and with its result.
    std::function<void(const std::string& what)> trace{};
  };
  HomingProgram(Setting setting, HomingJudge& judge, sim::Random random)
      : setting_{std::move(setting)}, judge_{judge}, random_{random} {}

  /// Works until the program is killed.
  void run();
  std::uint64_t homed() const noexcept { return homed_; }      ///< runs that have ended well
  std::uint64_t arrived() const noexcept { return arrived_; }  ///< moves that have ended well

 private:
  bool open();
  Done act();
  Done home();
  Done move();
  Done jog();
  takt::MotionBounds bounds() const;
  Eigen::VectorXd numbers(double largest);
  Done told(const std::string& what, Done done) const;

  Setting setting_;
  HomingJudge& judge_;
  sim::Random random_;
  std::optional<Axes> axes_;
  std::uint64_t homed_ = 0;
  std::uint64_t arrived_ = 0;
};

}  // namespace takt::soak
