#include "apps/takt/simulate/program/virtual_lcm.hpp"

#include <algorithm>
#include <utility>

namespace takt {

bool VirtualEndpoint::publish(const std::string& channel, std::span<const std::byte> data) {
  lcm_.carry(*this, channel, data);
  return true;
}

bool VirtualEndpoint::wanted(std::string_view channel) const {
  return lcm_.has_subscriber(channel);
}

bool VirtualEndpoint::hears(std::string_view channel) const noexcept {
  return std::ranges::find(channels_, channel) != channels_.end();
}

void VirtualEndpoint::serve(const MessageHandler& handler) {
  const Time now = lcm_.now();
  while (!waiting_.empty() && waiting_.front().arrival <= now) {
    const Message message = std::move(waiting_.front());
    waiting_.pop_front();
    handler(*message.channel, *message.data);
  }
}

VirtualEndpoint& VirtualLcm::join(std::size_t room, Echo echo) {
  return *endpoints_.emplace_back(std::make_unique<VirtualEndpoint>(*this, room, echo));
}

bool VirtualLcm::has_subscriber(std::string_view channel) const noexcept {
  return std::ranges::any_of(endpoints_,
                             [&](const auto& endpoint) { return endpoint->hears(channel); });
}

Time VirtualLcm::delay() noexcept {
  return Time{static_cast<Time::rep>(random_.next() % static_cast<std::uint64_t>(delay_.count()))};
}

void VirtualLcm::carry(const VirtualEndpoint& sender, const std::string& channel,
                       std::span<const std::byte> data) {
  ++messages_;
  VirtualEndpoint::Message message;
  for (const auto& endpoint : endpoints_) {
    if (!endpoint->hears(channel)) continue;
    if (endpoint.get() == &sender && endpoint->echo_ == Echo::unheard) continue;
    if (endpoint->waiting_.size() >= endpoint->room_) {
      ++endpoint->dropped_;
      continue;
    }
    if (!message.data) {
      message.channel = std::make_shared<const std::string>(channel);
      message.data = std::make_shared<const std::vector<std::byte>>(data.begin(), data.end());
    }
    message.arrival = now() + delay();
    if (!endpoint->waiting_.empty()) {
      message.arrival = std::max(message.arrival, endpoint->waiting_.back().arrival);
    }
    endpoint->waiting_.push_back(message);
  }
}

}  // namespace takt
