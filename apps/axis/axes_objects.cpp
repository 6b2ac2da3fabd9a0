#include <algorithm>
#include <fmt/format.h>
#include <set>

#include "apps/axis/axes_state.hpp"

// Objects of the devices, by SDO. taktd makes the transfers.

namespace takt {
namespace {

/// A request is sent again after this time, because LCM may lose the request or its answer.
constexpr std::chrono::milliseconds request_patience{500};
constexpr std::int16_t last_node_id = 127;

}  // namespace

std::expected<std::int16_t, Obstacle> Axes::State::node_id(const std::string& name) const {
  std::set<std::string> known;
  for (const signal_t& signal : group.input().signals()) {
    if (signal.node == name) return signal.node_id;
    known.insert(signal.node);
  }
  for (std::int16_t id = 1; id <= last_node_id; ++id) {
    const auto node = group.status_of_node(id);
    if (!node || node->name.empty()) continue;
    if (node->name == name) return id;
    known.insert(node->name);
  }
  return obstacle(Obstacle::Kind::wrong_use,
                  fmt::format("bus {} has no node '{}'; the nodes are: {}", group.bus(), name,
                              fmt::join(known, ", ")));
}

std::expected<Axes::State::Data, Obstacle> Axes::State::transfer(
    const std::string& service, const Object& object, std::span<const std::uint8_t> data) {
  if (!is_current()) return std::unexpected{restarted().error()};
  const auto node = node_id(object.node);
  if (!node) return std::unexpected{node.error()};
  request_t request{};
  request.id = ++request_id_;
  request.service = service;
  request.node_id = *node;
  request.index = object.index;
  request.sub = object.sub;
  request.data.assign(data.begin(), data.end());
  std::optional<reply_t> reply;
  std::optional<Clock::time_point> sent;
  const auto is_answered = [&] {
    for (reply_t& one : group.take_replies()) {
      if (one.id == request.id) reply = std::move(one);
    }
    if (!reply && (!sent || Clock::now() - *sent > request_patience)) {
      sent = Clock::now();
      group.send_request(request);
    }
    return reply.has_value();
  };
  const auto waited = wait_until(is_answered, options.longest);
  if (waited && !*waited) return std::unexpected{waited->error()};
  const std::string what = fmt::format("{} 0x{:04X}:{:02X}", object.node, object.index, object.sub);
  if (!reply) {
    return obstacle(Obstacle::Kind::time_over,
                    fmt::format("{}: taktd has not answered the SDO request", what));
  }
  if (reply->good) return Data{reply->data.begin(), reply->data.end()};
  return obstacle(Obstacle::Kind::blocked, fmt::format("{}: {}", what, reply->text));
}

std::expected<Axes::State::Data, Obstacle> Axes::read(const std::string& node, std::uint16_t index,
                                                      std::uint8_t sub) {
  return state_->transfer("sdo_upload", {.node = node, .index = index, .sub = sub}, {});
}

Done Axes::write(const std::string& node, std::uint16_t index, std::uint8_t sub,
                 std::span<const std::uint8_t> data) {
  const auto done =
      state_->transfer("sdo_download", {.node = node, .index = index, .sub = sub}, data);
  return done ? Done{} : std::unexpected{done.error()};
}

std::expected<std::uint64_t, Obstacle> Axes::read_bits(const std::string& node, std::uint16_t index,
                                                       std::uint8_t sub, std::size_t bytes) {
  const auto data = read(node, index, sub);
  if (!data) return std::unexpected{data.error()};
  if (data->size() != bytes) {
    return obstacle(Obstacle::Kind::wrong_use,
                    fmt::format("{} 0x{:04X}:{:02X} has {} bytes, not {}", node, index, sub,
                                data->size(), bytes));
  }
  std::uint64_t bits = 0;
  for (std::size_t i = 0; i < bytes; ++i) bits |= std::uint64_t{(*data)[i]} << (8 * i);
  return bits;
}

Done Axes::write_bits(const std::string& node, std::uint16_t index, std::uint8_t sub,
                      std::uint64_t bits, std::size_t bytes) {
  std::vector<std::uint8_t> data;
  for (std::size_t i = 0; i < bytes; ++i)
    data.push_back(static_cast<std::uint8_t>(bits >> (8 * i)));
  return write(node, index, sub, data);
}

}  // namespace takt
