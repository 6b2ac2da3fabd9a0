#pragma once
#include <algorithm>
#include <functional>
#include <optional>
#include <span>
#include <string>
#include <utility>
#include <vector>

#include "master/core/machine.hpp"
#include "master/core/network/network.hpp"
#include "master/rt/machines/services.hpp"
#include "master/rt/port.hpp"

namespace takt::test {

/// A port in virtual time that records the actions of the loop and answers SYNC as configured.
class FakePort {
 public:
  struct Answer {
    Frame frame;
    Time after{};  ///< delay after SYNC
  };
  struct Sent {
    Frame frame;
    Time when{};
  };

  Time now() noexcept { return now_; }
  void sleep_until(Time until) noexcept { note("sleep", until); }
  void sleep_precisely_until(Time until) noexcept {
    note("sleep", until);
    now_ += std::exchange(stall, std::exchange(second_stall, Time{}));
  }
  bool wait_frame(Time until) noexcept {
    const auto next = std::ranges::min_element(inbox, {}, &StampedFrame::when);
    const bool some = next != inbox.end() && next->when <= until;
    note("wait", some ? next->when : until);
    return some;
  }
  std::size_t receive(std::span<StampedFrame> in) noexcept {
    note("receive", now_ + std::exchange(receive_stall, Time{}));
    std::size_t count = 0;
    for (auto frame = inbox.begin(); frame != inbox.end() && count < in.size();) {
      if (frame->when > now_) {
        ++frame;
        continue;
      }
      in[count++] = *frame;
      frame = inbox.erase(frame);
    }
    return count;
  }
  SendResult send(std::span<const Frame> out) noexcept {
    note("send", now_ + std::exchange(send_stall, Time{}));
    const std::size_t taken = std::min(out.size(), room);
    for (const Frame& frame : out.first(taken)) {
      sent.push_back({frame, now_});
      if (frame.id == CobId::base(0x080)) {
        for (const Answer& answer : answers) inbox.push_back({answer.frame, now_ + answer.after});
      }
      if (on_sent) on_sent(frame);
    }
    return {taken, taken == out.size() ? 0 : error};
  }
  PortCondition condition() const noexcept { return news_now; }

  std::vector<Sent> sent_with(std::uint32_t id) const {
    std::vector<Sent> found;
    std::ranges::copy_if(sent, std::back_inserter(found),
                         [&](const Sent& s) { return s.frame.id.id() == id; });
    return found;
  }

  std::vector<Answer> answers;
  std::vector<StampedFrame> inbox;
  std::vector<Sent> sent;
  std::vector<std::string> calls;
  std::function<void(const Frame&)> on_sent;
  PortCondition news_now;
  Time stall{};          ///< delay of the next precise sleep
  Time second_stall{};   ///< delay of the precise sleep after that
  Time receive_stall{};  ///< duration of the next receive()
  Time send_stall{};     ///< delay of the frames of the next send()
  std::size_t room = 1000;
  int error = 0;

 private:
  void note(const char* call, Time until) {
    calls.emplace_back(call);
    now_ = std::max(now_, until);
  }
  Time now_ = std::chrono::seconds{10};
};
static_assert(Port<FakePort>);

/// Network services of a bus whose nodes are all ready; the tests decide what they send.
class FakeNetwork {
 public:
  explicit FakeNetwork(const BusPlan& plan, NetworkOptions options = {})
      : status_(plan.nodes.size(), NodeStatus{.boot = BootState::ready, .boot_count = 1}),
        up_(plan.nodes.size(), !options.observe) {
    newest = this;
  }
  void start(Time) noexcept {}
  void on_frame(const Frame& frame, Time, Outbox&) noexcept { heard.push_back(frame); }
  void on_time(Time, Outbox& out) noexcept {
    for (; !to_send.empty() && out.push(to_send.front(), answer); to_send.erase(to_send.begin())) {
    }
  }
  Time deadline() const noexcept { return never; }
  void on_absence(Time away) noexcept { absences.push_back(away); }
  bool streams() const noexcept { return false; }
  std::size_t awaited_sub_blocks() const noexcept { return sub_blocks; }
  std::size_t awaited_answers() const noexcept { return awaited; }
  bool submit(const Request& request, Time) noexcept {
    if (refuse) return false;
    submitted.push_back(request);
    replies.push_back({.id = request.id, .data = {}});
    return true;
  }
  bool take(Reply& reply) noexcept {
    if (replies.empty()) return false;
    reply = replies.front();
    replies.erase(replies.begin());
    return true;
  }
  bool take(Event&) noexcept { return false; }
  std::uint64_t events_lost() const noexcept { return lost_events; }
  void withdraw(std::uint64_t id) noexcept { withdrawn.push_back(id); }
  std::span<const NodeStatus> nodes() const noexcept { return status_; }
  bool exchanges_pdos(std::size_t node) const noexcept { return up_[node] && !stopping; }
  bool starts(std::size_t node) const noexcept { return starting && *starting == node; }
  void begin_stop(Time, NmtCommand last) noexcept {
    stopping = true;
    last_command = last;
  }
  bool stopped() const noexcept { return stopping; }
  bool boot_refused(std::size_t) const noexcept { return false; }
  std::span<const LimitReading> limits_read(std::size_t) const noexcept { return {}; }
  bool writes(std::uint8_t, ObjectKey) const noexcept { return false; }
  bool stops_drives() const noexcept { return lost_group.has_value(); }
  bool demands_quick_stop(std::size_t) const noexcept { return lost_group.value_or(false); }
  void on_sync_loss() noexcept { ++sync_losses; }
  void on_sync_back() noexcept { ++sync_returns; }
  bool take_sync_restart() noexcept { return std::exchange(restarts_sync, false); }
  NmtState own_state() const noexcept { return state; }
  std::optional<std::uint8_t> awaits_axes() const noexcept { return awaiting; }
  void axes_at_rest(AxesAtRest how) noexcept { rest = how; }
  void every_axis_at_rest(AxesAtRest how) noexcept { rest = how; }
  void drop_awaiting() noexcept { awaiting.reset(); }
  void give_up_boots(Time) noexcept {}
  bool idle() const noexcept { return true; }
  template <class Archive>
  void keep(Archive& archive) noexcept {
    archive(state);
  }

  void set_up(std::size_t node, bool up) { up_[node] = up; }

  std::vector<Frame> heard;
  std::vector<Frame> to_send;
  takt::Answer answer = takt::Answer::comes;  ///< that these frames expect
  std::size_t sub_blocks = 0;                 ///< that devices are sending
  std::vector<Request> submitted;
  std::vector<std::uint64_t> withdrawn;
  std::vector<Reply> replies;
  std::vector<Time> absences;
  std::size_t awaited = 0;
  std::optional<std::size_t> starting;
  bool refuse = false;
  bool stopping = false;
  NmtCommand last_command = NmtCommand::start;
  /// True while a node is lost whose loss stops drives, false when it is back; std::nullopt if no
  /// loss stops drives.
  std::optional<bool> lost_group;
  int sync_losses = 0;
  int sync_returns = 0;
  bool restarts_sync = false;
  NmtState state = NmtState::operational;
  std::optional<std::uint8_t> awaiting;  ///< as Network::awaits_axes()
  std::optional<AxesAtRest> rest;        ///< the newest report on axes that an NMT command awaits
  std::uint64_t lost_events = 0;
  static inline FakeNetwork* newest = nullptr;  ///< the instance in the newest loop

 private:
  std::vector<NodeStatus> status_;
  std::vector<bool> up_;
};
static_assert(Services<FakeNetwork>);

}  // namespace takt::test
