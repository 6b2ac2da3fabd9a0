#pragma once
#include <cstdint>
#include <deque>
#include <functional>
#include <map>
#include <memory>
#include <string>
#include <string_view>
#include <takt/lcm.hpp>
#include <vector>

#include "master/sim/bus/world.hpp"
#include "master/sim/random.hpp"

namespace takt {

class VirtualLcm;

/// States whether a program also receives its own messages.
enum class Echo : std::uint8_t { heard, unheard };

/// One program's connection to a VirtualLcm. Messages wait in a queue, like that of a socket, until
/// serve() takes them.
class VirtualEndpoint final : public Transport {
 public:
  /// `place` counts the programs of this LCM from 0.
  VirtualEndpoint(VirtualLcm& lcm, std::size_t place, std::size_t room, Echo echo)
      : lcm_{lcm}, place_{place}, room_{room}, echo_{echo} {}

  bool publish(const std::string& channel, std::span<const std::byte> data) override;
  /// True if a program has subscribed to the channel, as the broker of LCM reports.
  bool wanted(std::string_view channel) const override;
  /// Accepts whole names only, no patterns.
  void subscribe(const std::string& channel) override;
  void serve(const MessageHandler& handler) override;
  void watch(std::vector<pollfd>&) const override {}
  bool good() const override { return true; }
  std::string url() const override { return "virtual"; }

  /// Returns the arrival time of the oldest message in the queue, which may be in the future;
  /// `never` if the queue is empty.
  Time next_arrival() const noexcept { return waiting_.empty() ? never : waiting_.front().arrival; }
  /// Discards all waiting messages and subscriptions, as the end of the process does.
  void close();
  std::uint64_t dropped() const noexcept { return dropped_; }

 private:
  friend class VirtualLcm;
  struct Message {
    std::shared_ptr<const std::string> channel;
    std::shared_ptr<const std::vector<std::byte>> data;
    Time arrival{};
  };

  VirtualLcm& lcm_;
  std::size_t place_;
  std::size_t room_;
  Echo echo_;
  std::deque<Message> waiting_;
  std::uint64_t dropped_ = 0;
};

/// LCM in memory and in virtual time. Every message reaches all subscribers of its channel after a
/// random delay and in order. A full queue drops the newest message.
class VirtualLcm {
 public:
  static constexpr Time usual_delay = std::chrono::microseconds{150};

  VirtualLcm(const sim::World& world, sim::Random random) : world_{world}, random_{random} {}

  /// Adds a program whose queue holds `room` messages. The endpoint lives as long as the
  /// VirtualLcm.
  VirtualEndpoint& join(std::size_t room, Echo echo = Echo::heard);
  /// Sets the longest delay of the messages that are sent from now on.
  void set_delay(Time longest) noexcept { delay_ = longest; }
  Time now() const noexcept { return world_.now(); }
  std::uint64_t messages() const noexcept { return messages_; }

 private:
  friend class VirtualEndpoint;
  /// Subscribers of one channel in the order in which they have joined.
  using Subscribers = std::vector<VirtualEndpoint*>;

  void subscribe(VirtualEndpoint& program, const std::string& channel);
  void unsubscribe(VirtualEndpoint& program);
  const Subscribers& subscribers(std::string_view channel) const noexcept;
  void carry(const VirtualEndpoint& sender, const std::string& channel,
             std::span<const std::byte> data);
  Time delay() noexcept;

  const sim::World& world_;
  sim::Random random_;
  Time delay_ = usual_delay;
  std::vector<std::unique_ptr<VirtualEndpoint>> endpoints_;
  std::map<std::string, Subscribers, std::less<>> subscribers_;  // keys are channels
  Subscribers nobody_;
  std::uint64_t messages_ = 0;
};

}  // namespace takt
