#pragma once
#include <functional>
#include <string>
#include <takt/command_t.hpp>
#include <takt/lcm.hpp>
#include <utility>
#include <vector>

#include "master/lcm/messages.hpp"

namespace takt {

/// For tests: a transport that changes each command before the daemon receives it. Without a
/// function it changes nothing.
class RewritingTransport final : public Transport {
 public:
  using Rewrite = std::function<void(command_t& command)>;

  /// `inner` must outlive the transport. `channel` is that of the commands.
  RewritingTransport(Transport& inner, std::string channel)
      : inner_{inner}, channel_{std::move(channel)} {}
  void rewrite(Rewrite rewrite) { rewrite_ = std::move(rewrite); }

  bool publish(const std::string& channel, std::span<const std::byte> data) override {
    return inner_.publish(channel, data);
  }
  bool wanted(std::string_view channel) const override { return inner_.wanted(channel); }
  void subscribe(const std::string& pattern) override { inner_.subscribe(pattern); }
  void serve(const MessageHandler& handler) override {
    if (!rewrite_) return inner_.serve(handler);
    inner_.serve([&](std::string_view channel, std::span<const std::byte> data) {
      handler(channel, channel == channel_ ? rewritten(data) : data);
    });
  }
  void watch(std::vector<pollfd>& descriptors) const override { inner_.watch(descriptors); }
  bool good() const override { return inner_.good(); }
  std::string url() const override { return inner_.url(); }

 private:
  std::span<const std::byte> rewritten(std::span<const std::byte> data) {
    auto command = decode<command_t>(data);
    if (!command) return data;
    rewrite_(*command);
    return encode(*command, buffer_);
  }

  Transport& inner_;
  std::string channel_;
  Rewrite rewrite_;
  std::vector<std::byte> buffer_;
};

}  // namespace takt
