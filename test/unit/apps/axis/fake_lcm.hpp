#pragma once
#include <cstddef>
#include <deque>
#include <string>
#include <takt/lcm.hpp>
#include <utility>
#include <vector>

#include "master/lcm/messages.hpp"

namespace takt::test {

/// An LCM that the test controls.
struct FakeLcm {
  std::deque<std::pair<std::string, std::vector<std::byte>>> arriving;
  std::vector<std::pair<std::string, std::vector<std::byte>>> published;
  std::vector<std::string> patterns;

  template <class T>
  void arrive(const std::string& channel, const T& message) {
    std::vector<std::byte> buffer;
    encode(message, buffer);
    arriving.emplace_back(channel, buffer);
  }
};

class FakeTransport final : public Transport {
 public:
  explicit FakeTransport(FakeLcm& lcm) : lcm_{lcm} {}
  bool publish(const std::string& channel, std::span<const std::byte> data) override {
    lcm_.published.emplace_back(channel, std::vector<std::byte>{data.begin(), data.end()});
    return true;
  }
  void subscribe(const std::string& pattern) override { lcm_.patterns.push_back(pattern); }
  void serve(const MessageHandler& handler) override {
    while (!lcm_.arriving.empty()) {
      handler(lcm_.arriving.front().first, lcm_.arriving.front().second);
      lcm_.arriving.pop_front();
    }
  }
  void watch(std::vector<pollfd>&) const override {}
  bool good() const override { return true; }
  std::string url() const override { return "test"; }

 private:
  FakeLcm& lcm_;
};

}  // namespace takt::test
