#include <chrono>
#include <fmt/format.h>
#include <utility>

#include "master/gateway/bridge.hpp"

namespace takt {
namespace {

constexpr Time longest_way = std::chrono::seconds{10};  // until a request arrives
constexpr Time most_ahead = std::chrono::seconds{1};    // largest clock difference of two machines

}  // namespace

void Bridge::serve_requests() {
  const FrontBudget budget{clock_, FrontBudget::requests};
  take_replies(budget);
  transfers_left_ = transfers_.on_time(clocks_.now(), budget);
}

void Bridge::take_replies(const FrontBudget& budget) {
  Reply reply;
  do {
    replies_left_ = master_.take(reply);
    if (replies_left_) take_reply(reply);
  } while (replies_left_ && budget.is_left());
}

void Bridge::take_reply(const Reply& reply) {
  if (transfers_.finish(reply)) return;
  if ((reply.id & FrontGuest::mark) != 0) {
    if (guest_ != nullptr) guest_->take(reply);
    return;
  }
  if (reply.fault == SdoFault::axes_not_stopped) {
    do {
      take_events();  // events sent before the reply name the axes
    } while (events_left_);
  }
  if (auto message = requests_.finish(reply, clocks_.now(), stop_text_)) {
    answer(std::move(*message));
  }
}

void Bridge::answer(reply_t reply) { publish(channels_.reply, reply, clocks_.now()); }

void Bridge::on_request(Bytes data) {
  const auto request = decode<request_t>(data);
  if (!request) return report_damaged(channels_.request, request.error());
  const Time now = clocks_.now();
  if (requests_.is_echo(*request, now)) return;
  const bool fits = !Requests::oversize(*request);
  const std::string failure = age_error(request->utime, now);
  const bool old = fits && request->schema == message_schema && !failure.empty();
  if (old) return answer(requests_.refusal(*request, failure));
  if (fits && request->service == "emcy_history") return answer_history(*request);
  if (fits && request->service == "device_file") return answer_device_file(*request);
  const bool records = fits && request->service == "record" && record_;
  auto reply = records ? requests_.take(*request, now, record_) : requests_.take(*request, now);
  if (reply) answer(std::move(*reply));
}

std::string Bridge::age_error(std::int64_t utime, Time now) const {
  const auto wall = [this](Time monotonic) {
    return (monotonic + clocks_.wall_offset()) / std::chrono::microseconds{1};
  };
  const auto& [length, end] = gap_.newest_long();
  const bool old = utime < wall(now - longest_way);
  const bool before_gap_ended = end != Time{0} && utime < wall(end);
  if (gap_.discards_requests(now) || (before_gap_ended && !old)) {
    return fmt::format(
        "taktd did not run for {} ms, and the request may have waited as long: send it again",
        length / std::chrono::milliseconds{1});
  }
  if (old) {
    return "the time of the request (utime) is more than 10 s before the clock of taktd's machine: "
           "the request waited too long, comes from a log, or the clocks of the two machines "
           "differ";
  }
  if (utime <= wall(now + most_ahead)) return {};
  return "the time of the request (utime) is more than 1 s ahead of the clock of taktd's machine: "
         "the clocks of the two machines differ";
}

void Bridge::answer(const request_t& request, bool good, const std::string& text) {
  reply_t reply = requests_.reply_to(request);
  reply.good = good ? 1 : 0;
  reply.text = text;
  requests_.finish(request, reply, clocks_.now());
  answer(std::move(reply));
}

/// Answers from the log of the bridge, because the bus thread keeps no history.
void Bridge::answer_history(const request_t& request) {
  if (auto refused = requests_.refuse_foreign(request)) return answer(std::move(*refused));
  reply_t reply = requests_.reply_to(request);
  reply.good = request.node_id > 0 && request.node_id <= 127 ? 1 : 0;
  if (reply.good == 0) {
    reply.text = fmt::format("node {} is not in 1..127", request.node_id);
  } else {
    const auto& records = emcy_log_.of(static_cast<std::uint8_t>(request.node_id));
    const NodePlan* const node = master_.plan().find(static_cast<unsigned>(request.node_id));
    if (node != nullptr) reply.text = pack_texts(records, node->emcy_texts);
    reply.data = pack(records);
    reply.size = static_cast<std::int32_t>(reply.data.size());
  }
  answer(std::move(reply));
}

/// Answers with the path of the device file on this machine. The requester reads the names of the
/// objects there, because the daemon keeps no names of objects.
void Bridge::answer_device_file(const request_t& request) {
  if (auto refused = requests_.refuse_foreign(request)) return answer(std::move(*refused));
  reply_t reply = requests_.reply_to(request);
  const std::size_t node = master_.plan().index_of(static_cast<unsigned>(request.node_id));
  const bool known = node < options_.device_files.size() && !options_.device_files[node].empty();
  reply.good = known ? 1 : 0;
  reply.text = known ? options_.device_files[node]
                     : fmt::format("no device file of node {} is known", request.node_id);
  answer(std::move(reply));
}

void Bridge::on_transfer(Bytes data) {
  const auto transfer = decode<transfer_t>(data);
  if (!transfer) return report_damaged(channels_.transfer, transfer.error());
  const Time now = clocks_.now();
  const std::string failure = age_error(transfer->utime, now);
  if (failure.empty()) return transfers_.take(*transfer, now);
  transfers_.take_old(*transfer, failure);
}

}  // namespace takt
