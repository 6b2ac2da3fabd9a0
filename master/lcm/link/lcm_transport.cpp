#include "master/lcm/link/lcm_transport.hpp"

#include <utility>

namespace takt {
namespace {

constexpr int queue_capacity = 100;  // messages per subscription that may wait for serve()

}  // namespace

std::unique_ptr<LcmTransport> LcmTransport::create(const std::string& url, FrontClock clock) {
  std::unique_ptr<lcm_t, Destroy> lcm{lcm_create(url.c_str())};
  if (!lcm) return nullptr;
  return std::unique_ptr<LcmTransport>{new LcmTransport{std::move(lcm), url, std::move(clock)}};
}

bool LcmTransport::publish(const std::string& channel, std::span<const std::byte> data) {
  return lcm_publish(lcm_.get(), channel.c_str(), data.data(),
                     static_cast<unsigned>(data.size())) == 0;
}

void LcmTransport::subscribe(const std::string& pattern) {
  lcm_subscription_t* const made = lcm_subscribe(lcm_.get(), pattern.c_str(), on_message, this);
  if (made == nullptr) {
    good_ = false;
    return;
  }
  lcm_subscription_set_queue_capacity(made, queue_capacity);
}

void LcmTransport::on_message(const lcm_recv_buf_t* buffer, const char* channel, void* self) {
  const auto* const transport = static_cast<const LcmTransport*>(self);
  const auto* const bytes = static_cast<const std::byte*>(buffer->data);
  (*transport->handler_)(channel, {bytes, buffer->data_size});
}

void LcmTransport::serve(const MessageHandler& handler) {
  handler_ = &handler;
  const FrontBudget budget{clock_, FrontBudget::lcm};
  do {
    const int handled = lcm_handle_timeout(lcm_.get(), 0);
    if (handled < 0) good_ = false;
    drained_ = handled <= 0;
  } while (!drained_ && budget.is_left());
  handler_ = nullptr;
}

void LcmTransport::watch(std::vector<pollfd>& descriptors) const {
  descriptors.push_back({.fd = lcm_get_fileno(lcm_.get()), .events = POLLIN, .revents = 0});
}

}  // namespace takt
