#pragma once
#include <deque>
#include <functional>
#include <string>
#include <utility>
#include <vector>

#include "test/motions/motion_bus.hpp"

namespace takt::test {

/// The end of a link on which an application listens. A cycle passes each time that it looks for
/// messages.
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

/// Repeats a call of Axes that depends on the clock of the machine, at most ten times. Returns true
/// if it has succeeded.
template <class Call>
bool succeeds_at_last(Call call) {
  for (int i = 0; i < 10; ++i) {
    if (call()) return true;
  }
  return false;
}

}  // namespace takt::test
