#pragma once
#include <chrono>
#include <cstdint>
#include <deque>
#include <functional>
#include <span>
#include <string>
#include <utility>
#include <vector>

#include "apps/axis/group/surroundings.hpp"
#include "test/motions/motion_bus.hpp"

namespace takt::test {

/// The end of a link at which an application receives. A cycle passes each time that the
/// application looks for messages.
class LinkInVirtualTime final : public Transport {
 public:
  explicit LinkInVirtualTime(MotionBus& bus) : bus_{bus} {
    bus_.lcm.listener = [this](const std::string& channel, std::span<const std::byte> data) {
      arriving_.emplace_back(channel, std::vector<std::byte>{data.begin(), data.end()});
    };
  }
  ~LinkInVirtualTime() override { bus_.lcm.listener = {}; }
  LinkInVirtualTime(const LinkInVirtualTime&) = delete;
  LinkInVirtualTime& operator=(const LinkInVirtualTime&) = delete;

  bool publish(const std::string& channel, std::span<const std::byte> data) override {
    if (loses && loses(channel)) return true;
    bus_.lcm.waiting.emplace_back(channel, std::vector<std::byte>{data.begin(), data.end()});
    return true;
  }
  void subscribe(const std::string&) override {}
  void serve(const MessageHandler& handler) override {
    bus_.cycle();
    for (const auto& [channel, data] : std::exchange(arriving_, {})) handler(channel, data);
  }
  void watch(std::vector<pollfd>&) const override {}
  bool good() const override { return true; }
  std::string url() const override { return {}; }

  std::function<bool(const std::string& channel)> loses;  ///< messages to taktd

 private:
  MotionBus& bus_;
  std::deque<std::pair<std::string, std::vector<std::byte>>> arriving_;
};

/// The machine of an application, with a monotonic clock that a test sets forward.
class ClockAhead final : public Surroundings {
 public:
  std::chrono::nanoseconds now() override { return machine_.now() + ahead; }
  std::chrono::nanoseconds wall() override { return machine_.wall(); }
  void wait(std::span<pollfd> descriptors, std::chrono::nanoseconds longest) override {
    machine_.wait(descriptors, longest);
  }
  std::int64_t random_number() override { return machine_.random_number(); }

  std::chrono::nanoseconds ahead{};

 private:
  Surroundings& machine_ = surroundings();
  UseSurroundings here_{*this};
};

}  // namespace takt::test
