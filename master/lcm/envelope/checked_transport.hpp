#pragma once
#include <functional>
#include <memory>
#include <string>
#include <takt/lcm.hpp>
#include <vector>

#include "eds_parser/values/time.hpp"
#include "master/lcm/channel_pattern.hpp"
#include "master/lcm/envelope/envelope.hpp"
#include "master/lcm/envelope/key_file.hpp"
#include "master/linux/clock.hpp"

namespace takt {

/// A transport for programs that accept only messages signed by the daemon (`authenticate:
/// images`). It receives the envelopes of BUS_SIGNED and hands over their contents. It drops
/// messages without an envelope, and forged, altered, repeated, delayed or reordered envelopes. It
/// reads a changed key file again within a second. All calls come from one thread.
class CheckedTransport final : public Transport {
 public:
  /// `wall` returns the time of CLOCK_REALTIME.
  CheckedTransport(std::unique_ptr<Transport> inner, WatchedKeyFile keys,
                   std::function<Time()> wall = realtime_now);

  bool publish(const std::string& channel, std::span<const std::byte> data) override {
    return inner_->publish(channel, data);
  }
  bool wanted(std::string_view channel) const override { return inner_->wanted(channel); }
  void subscribe(const std::string& pattern) override;
  void serve(const MessageHandler& handler) override;
  bool drained() const override { return inner_->drained(); }
  void watch(std::vector<pollfd>& descriptors) const override { inner_->watch(descriptors); }
  bool good() const override { return inner_->good(); }
  std::string url() const override { return inner_->url() + " (signed messages only)"; }

  /// Returns the number of dropped messages.
  std::uint64_t refused() const noexcept { return refused_; }

 private:
  void take(std::string_view channel, Bytes data, const MessageHandler& handler);
  void reread_keys();

  std::unique_ptr<Transport> inner_;
  WatchedKeyFile keys_;
  std::function<Time()> wall_;
  EnvelopeGuard guard_{std::nullopt};
  std::vector<ChannelPattern> patterns_;
  Time next_look_{};
  std::uint64_t refused_ = 0;
};

}  // namespace takt
