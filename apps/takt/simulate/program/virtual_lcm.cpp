#include "apps/takt/simulate/program/virtual_lcm.hpp"

#include <algorithm>
#include <utility>

namespace takt {

bool VirtualEndpoint::publish(const std::string& channel, std::span<const std::byte> data) {
  lcm_.carry(*this, channel, data);
  return true;
}

bool VirtualEndpoint::wanted(std::string_view channel) const {
  return !lcm_.subscribers(channel).empty();
}

void VirtualEndpoint::subscribe(const std::string& channel) { lcm_.subscribe(*this, channel); }

void VirtualEndpoint::close() {
  waiting_.clear();
  lcm_.unsubscribe(*this);
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
  return *endpoints_.emplace_back(
      std::make_unique<VirtualEndpoint>(*this, endpoints_.size(), room, echo));
}

void VirtualLcm::subscribe(VirtualEndpoint& program, const std::string& channel) {
  Subscribers& all = subscribers_[channel];
  const auto at = std::ranges::lower_bound(all, program.place_, {}, &VirtualEndpoint::place_);
  if (at == all.end() || *at != &program) all.insert(at, &program);
}

void VirtualLcm::unsubscribe(VirtualEndpoint& program) {
  for (auto& [channel, all] : subscribers_) std::erase(all, &program);
}

const VirtualLcm::Subscribers& VirtualLcm::subscribers(std::string_view channel) const noexcept {
  const auto found = subscribers_.find(channel);
  return found == subscribers_.end() ? nobody_ : found->second;
}

Time VirtualLcm::delay() noexcept {
  return Time{static_cast<Time::rep>(random_.next() % static_cast<std::uint64_t>(delay_.count()))};
}

void VirtualLcm::carry(const VirtualEndpoint& sender, const std::string& channel,
                       std::span<const std::byte> data) {
  ++messages_;
  VirtualEndpoint::Message message;
  for (VirtualEndpoint* const endpoint : subscribers(channel)) {
    if (endpoint == &sender && endpoint->echo_ == Echo::unheard) continue;
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
