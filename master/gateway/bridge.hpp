#pragma once
#include <array>
#include <chrono>
#include <cstdint>
#include <functional>
#include <optional>
#include <string>
#include <vector>

#include "master/gateway/clocks.hpp"
#include "master/gateway/commands.hpp"
#include "master/gateway/emcy_history.hpp"
#include "master/gateway/emcy_log.hpp"
#include "master/gateway/front_gap.hpp"
#include "master/gateway/front_guest.hpp"
#include "master/gateway/image_messages.hpp"
#include "master/gateway/messages.hpp"
#include "master/gateway/notice.hpp"
#include "master/gateway/notice_limit.hpp"
#include "master/gateway/pdo_outages.hpp"
#include "master/gateway/requests.hpp"
#include "master/gateway/status_messages.hpp"
#include "master/gateway/time_budget.hpp"
#include "master/gateway/transfers.hpp"
#include "master/gateway/transport.hpp"
#include "master/gateway/typed_channels.hpp"
#include "master/master.hpp"

namespace takt {

/// LCM channels of one bus.
struct Channels {
  explicit Channels(const std::string& bus);
  std::string image, layout, command, status, sync, pdos, timing, event, request, reply, transfer,
      transfer_state;
  /// Those that the daemon hears.
  std::vector<std::string> heard() const { return {command, request, transfer}; }
};

struct BridgeOptions {
  std::int64_t session = 0;
  bool observe = false;
  std::string interface;  ///< told in status_t
  std::string realtime;   ///< told in status_t
  bool typed = true;      ///< a typed message of each node as well, see TypedChannels
};

/// The work of the front thread: images, states and events of a Master become messages, messages
/// become set-points and requests. Reads clocks, never waits.
class Bridge {
 public:
  /// `tell` hears what LCM hears of events and of the gateway's own notices, after it has.
  Bridge(Master& master, Transport& transport, const Clocks& clocks, BridgeOptions options,
         NoticeSink tell);

  /// Somebody else who hears images, events and the answers to requests with FrontGuest::mark.
  /// Outlives this.
  void welcome(FrontGuest& guest) noexcept { guest_ = &guest; }
  /// Commands outputs as a command_t would that was computed in this cycle. False: refused, and
  /// told.
  bool command(const std::string& sender, std::span<const SignalIndex> signals,
               std::span<const std::int64_t> values);
  /// How often this thread did not run for so long that requests which waited are discarded.
  std::uint64_t gaps() const noexcept { return gaps_; }
  Time newest_gap() const noexcept { return gap_.length(); }
  /// Everything that can be done now. True: there was an image.
  bool serve();
  /// Events or answers of the bus thread are left over for the next round, or may be.
  bool owes_news() const noexcept { return replies_left_ || events_left_; }
  /// When serve() has to be called again at the latest: at once where something is left over, else
  /// when status_t, pdo_status_t, layout_t or timing_t go out.
  Time next_message() const noexcept;
  /// An event of the bus thread or of the diagnostic socket.
  void tell(const Event& event);
  /// A notice of somebody else. Told to LCM and to `tell`, unless there are too many of its kind.
  void tell(Notice notice);

  /// Who answers `record` requests, by answer(); without one they are refused.
  using Record = std::function<void(const request_t& request)>;
  void record_with(Record record) { record_ = std::move(record); }
  /// Answers a request that the bus thread has no part in.
  void answer(const request_t& request, bool good, const std::string& text);

  const StatusSnapshot& status() const noexcept { return snapshot_; }
  std::uint64_t images() const noexcept { return images_; }
  std::uint64_t commands_taken() const noexcept { return commands_.taken(); }
  std::uint64_t commands_refused() const noexcept { return commands_.refused(); }
  /// By reason, in the order of CommandRefusal.
  const auto& refusals() const noexcept { return commands_.refusals(); }
  /// Messages that could not be read.
  std::uint64_t damaged() const noexcept { return damaged_count_; }
  const Histogram& sync_to_lcm() const noexcept { return sync_to_lcm_; }
  const Channels& channels() const noexcept { return channels_; }

 private:
  bool publish_images();
  void publish_image(const ImageView& image, bool typed);
  /// Looks whether this thread has stood still. What waited meanwhile is not acted upon.
  void notice_gap();
  /// The cycle of this moment by the clock: images that were not seen yet count as well.
  std::uint64_t cycle_at(Time now) const noexcept;
  bool take_at(const command_t& command, Time now);
  void publish_outputs();
  /// Why a request is too old to be done; empty: it isn't.
  std::string age_trouble(std::int64_t utime, Time now) const;
  void take_events();
  void take_event(const Event& event);
  /// By the bus thread, and on the way from there.
  std::uint64_t events_lost() const noexcept;
  void tell_lost_events();
  void add_sender(const Event& event, Notice& notice) const;
  void remember(const Event& event);
  void take_replies(const TimeBudget& budget);
  void take_reply(const Reply& reply);
  void serve_requests();
  void take_messages();
  void on_message(std::string_view channel, Bytes data);
  void on_command(Bytes data);
  void on_typed(std::string_view channel, Bytes data);
  void take_command(const command_t& command);
  void on_request(Bytes data);
  void send(Notice notice);
  reply_t reply_to(const request_t& request) const;
  void answer_history(const request_t& request);
  void on_transfer(Bytes data);
  void tell_damaged(const std::string& channel, DecodeFault fault);
  /// A message that goes out by the clock.
  struct PeriodicState {
    Time period;
    void (Bridge::*publish)(Time now);
    Time next{};
  };

  const PeriodicState& first_state() const noexcept;
  void publish_states(bool after_image);
  void publish_layout(Time now);
  void publish_status(Time now);
  void publish_pdos(Time now);
  void publish_timing(Time now);
  void answer(reply_t reply);
  void tell_transfer(transfer_state_t state);
  std::int64_t wall_microseconds(Time monotonic) const noexcept;
  template <class T>
  void publish(const std::string& channel, const T& message) {
    transport_.publish(channel, encode(message, buffer_));
  }

  Master& master_;
  Transport& transport_;
  const Clocks& clocks_;
  FrontClock clock_ = [this] { return clocks_.now(); };
  BridgeOptions options_;
  NoticeSink tell_;
  FrontGuest* guest_ = nullptr;
  Record record_;
  Channels channels_;
  ImageMessages image_messages_;
  std::optional<TypedChannels> typed_;
  std::vector<layout_t> layout_messages_;
  StatusMessages status_messages_;
  TimingMessages timing_messages_;
  Histogram sync_to_lcm_;  // from SYNC until the image is handed over, typed messages included
  Commands commands_;
  Requests requests_;
  Transfers transfers_;
  PdoOutages outages_;
  NoticeLimit limit_;
  EmcyHistory emcys_;
  std::string stop_text_;  ///< a line for each axis that the newest stop did not confirm
  Time stop_told_{};       ///< when that stop ended
  std::uint64_t damaged_count_ = 0;
  RateLimit damaged_{std::chrono::seconds{10}};
  std::vector<std::byte> buffer_;
  StatusSnapshot snapshot_;
  std::vector<PdoMark> marks_;  // of the newest image
  EmcyLog emcy_log_;
  Time wall_minus_monotonic_{};
  std::array<PeriodicState, 4> states_{{{std::chrono::seconds{1}, &Bridge::publish_layout},
                                        {std::chrono::milliseconds{100}, &Bridge::publish_status},
                                        {std::chrono::milliseconds{500}, &Bridge::publish_pdos},
                                        {std::chrono::seconds{1}, &Bridge::publish_timing}}};
  /// So long a state that is due waits for an image that it can follow.
  Time image_wait_;
  std::uint64_t cycle_ = 0;  // of the newest image
  Time sync_time_{};         // of the newest image
  Time judged_{};            // of the commands that are staged: when their age was judged first
  FrontGap gap_;
  std::uint64_t gaps_ = 0;
  bool skip_images_ = false;  // those that waited over a gap
  std::uint64_t images_ = 0;
  std::uint64_t events_lost_told_ = 0;
  bool outputs_staged_ = false;
  bool replies_left_ = false;    // when the budget of this round ended
  bool transfers_left_ = false;  // steps of them
  bool events_left_ = false;
  std::int64_t instance_;  // of the daemon itself, as a sender of commands
};

}  // namespace takt
