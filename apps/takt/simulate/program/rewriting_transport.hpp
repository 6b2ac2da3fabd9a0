#pragma once
#include <functional>
#include <string>
#include <takt/command_t.hpp>
#include <takt/lcm.hpp>
#include <takt/motion_command_t.hpp>
#include <utility>
#include <vector>

#include "master/lcm/messages.hpp"

namespace takt {

/// For tests: a transport that changes each command, and each message about motions, before the
/// daemon receives it. Without functions it changes nothing.
class RewritingTransport final : public Transport {
 public:
  using Rewrite = std::function<void(command_t& command)>;
  /// Returns the messages that the daemon receives instead of this one.
  using RewriteMotion = std::function<std::vector<motion_command_t>(motion_command_t command)>;

  /// `inner` must outlive the transport. The channels are those of the commands and of motions.
  RewritingTransport(Transport& inner, std::string channel, std::string motion_channel)
      : inner_{inner}, channel_{std::move(channel)}, motion_channel_{std::move(motion_channel)} {}
  void rewrite(Rewrite rewrite) { rewrite_ = std::move(rewrite); }
  void rewrite(RewriteMotion rewrite) { rewrite_motion_ = std::move(rewrite); }

  bool publish(const std::string& channel, std::span<const std::byte> data) override {
    return inner_.publish(channel, data);
  }
  bool wanted(std::string_view channel) const override { return inner_.wanted(channel); }
  void subscribe(const std::string& pattern) override { inner_.subscribe(pattern); }
  void serve(const MessageHandler& handler) override {
    if (!rewrite_ && !rewrite_motion_) return inner_.serve(handler);
    inner_.serve([&](std::string_view channel, std::span<const std::byte> data) {
      if (rewrite_motion_ && channel == motion_channel_) return serve_motion(handler, data);
      handler(channel, rewrite_ && channel == channel_ ? rewritten(data) : data);
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

  void serve_motion(const MessageHandler& handler, std::span<const std::byte> data) {
    auto command = decode<motion_command_t>(data);
    if (!command) return handler(motion_channel_, data);
    for (const motion_command_t& one : rewrite_motion_(std::move(*command))) {
      handler(motion_channel_, encode(one, buffer_));
    }
  }

  Transport& inner_;
  std::string channel_;
  std::string motion_channel_;
  Rewrite rewrite_;
  RewriteMotion rewrite_motion_;
  std::vector<std::byte> buffer_;
};

}  // namespace takt
