#pragma once
#include <functional>
#include <string>
#include <takt/command_t.hpp>
#include <takt/lcm.hpp>
#include <takt/motion_command_t.hpp>
#include <takt/motion_gear_t.hpp>
#include <takt/motion_stream_t.hpp>
#include <utility>
#include <vector>

#include "master/gateway/bridge.hpp"
#include "master/lcm/messages.hpp"

namespace takt {

/// For tests: a transport that changes each command, and each message about motions, gears or
/// streams, before the daemon receives it. Without functions it changes nothing.
class RewritingTransport final : public Transport {
 public:
  using Rewrite = std::function<void(command_t& command)>;
  /// Returns the messages that the daemon receives instead of this one.
  using RewriteMotion = std::function<std::vector<motion_command_t>(motion_command_t command)>;
  using RewriteGear = std::function<void(motion_gear_t& gear)>;
  using RewriteStream = std::function<void(motion_stream_t& stream)>;

  /// `inner` must outlive the transport.
  RewritingTransport(Transport& inner, Channels channels)
      : inner_{inner}, channels_{std::move(channels)} {}
  void rewrite(Rewrite rewrite) { rewrite_ = std::move(rewrite); }
  void rewrite(RewriteMotion rewrite) { rewrite_motion_ = std::move(rewrite); }
  void rewrite(RewriteGear rewrite) { rewrite_gear_ = std::move(rewrite); }
  void rewrite(RewriteStream rewrite) { rewrite_stream_ = std::move(rewrite); }

  bool publish(const std::string& channel, std::span<const std::byte> data) override {
    return inner_.publish(channel, data);
  }
  bool wanted(std::string_view channel) const override { return inner_.wanted(channel); }
  void subscribe(const std::string& pattern) override { inner_.subscribe(pattern); }
  void serve(const MessageHandler& handler) override {
    inner_.serve([&](std::string_view channel, std::span<const std::byte> data) {
      if (rewrite_motion_ && channel == channels_.motion_command) {
        return serve_motion(handler, data);
      }
      if (rewrite_ && channel == channels_.command) data = rewritten(rewrite_, data);
      if (rewrite_gear_ && channel == channels_.motion_gear) data = rewritten(rewrite_gear_, data);
      if (rewrite_stream_ && channel == channels_.motion_stream) {
        data = rewritten(rewrite_stream_, data);
      }
      handler(channel, data);
    });
  }
  void watch(std::vector<pollfd>& descriptors) const override { inner_.watch(descriptors); }
  bool good() const override { return inner_.good(); }
  std::string url() const override { return inner_.url(); }

 private:
  template <class Message>
  std::span<const std::byte> rewritten(const std::function<void(Message& message)>& rewrite,
                                       std::span<const std::byte> data) {
    auto message = decode<Message>(data);
    if (!message) return data;
    rewrite(*message);
    return encode(*message, buffer_);
  }

  void serve_motion(const MessageHandler& handler, std::span<const std::byte> data) {
    auto command = decode<motion_command_t>(data);
    if (!command) return handler(channels_.motion_command, data);
    for (const motion_command_t& one : rewrite_motion_(std::move(*command))) {
      handler(channels_.motion_command, encode(one, buffer_));
    }
  }

  Transport& inner_;
  Channels channels_;
  Rewrite rewrite_;
  RewriteMotion rewrite_motion_;
  RewriteGear rewrite_gear_;
  RewriteStream rewrite_stream_;
  std::vector<std::byte> buffer_;
};

}  // namespace takt
