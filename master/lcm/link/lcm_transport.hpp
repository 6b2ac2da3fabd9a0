#pragma once
#include <lcm/lcm.h>
#include <memory>
#include <string>
#include <takt/lcm.hpp>
#include <utility>
#include <vector>

#include "master/lcm/front_budget.hpp"
#include "master/linux/clock.hpp"

namespace takt {

/// The LCM library as a Transport: udpm://, memq://, file://.
class LcmTransport final : public Transport {
 public:
  /// Returns nullptr if LCM refuses (it prints the reason to stderr). The first subscribe() may
  /// take seconds, because LCM then tests multicast.
  static std::unique_ptr<LcmTransport> create(const std::string& url,
                                              FrontClock clock = monotonic_now);

  bool publish(const std::string& channel, std::span<const std::byte> data) override;
  void subscribe(const std::string& pattern) override;
  void serve(const MessageHandler& handler) override;
  bool drained() const override { return drained_; }
  void watch(std::vector<pollfd>& descriptors) const override;
  bool good() const override { return good_; }
  std::string url() const override { return url_; }

 private:
  struct Destroy {
    void operator()(lcm_t* lcm) const noexcept { lcm_destroy(lcm); }
  };

  LcmTransport(std::unique_ptr<lcm_t, Destroy> lcm, std::string url, FrontClock clock)
      : lcm_{std::move(lcm)}, url_{std::move(url)}, clock_{std::move(clock)} {}
  static void on_message(const lcm_recv_buf_t* buffer, const char* channel, void* self);

  std::unique_ptr<lcm_t, Destroy> lcm_;
  std::string url_;
  FrontClock clock_;
  const MessageHandler* handler_ = nullptr;  // set during serve()
  bool good_ = true;
  bool drained_ = true;  // serve() found no further message
};

}  // namespace takt
