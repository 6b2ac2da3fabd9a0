#pragma once
#include <array>
#include <chrono>
#include <cstdint>
#include <optional>
#include <string>
#include <takt/lcm.hpp>
#include <vector>

#include "master/gateway/command/commands.hpp"
#include "master/gateway/command/requests.hpp"
#include "master/gateway/command/transfers.hpp"
#include "master/gateway/front_gap.hpp"
#include "master/gateway/front_guest.hpp"
#include "master/gateway/message/image_messages.hpp"
#include "master/gateway/message/speed_messages.hpp"
#include "master/gateway/message/status_messages.hpp"
#include "master/gateway/message/typed_channels.hpp"
#include "master/gateway/motion/motion_commands.hpp"
#include "master/gateway/notice/emcy_log.hpp"
#include "master/gateway/notice/notice.hpp"
#include "master/gateway/notice/notice_limit.hpp"
#include "master/gateway/notice/pdo_outages.hpp"
#include "master/lcm/clocks.hpp"
#include "master/lcm/front_budget.hpp"
#include "master/lcm/messages.hpp"
#include "master/master_run.hpp"

namespace takt {

/// The LCM channels of one bus.
struct Channels {
  explicit Channels(const std::string& bus);
  std::string image, layout, speed_axes, command, motion, motion_command, motion_gear,
      motion_stream, status, sync, pdos, timing, event, request, reply, transfer, transfer_state;
  /// Returns the channels that the daemon receives.
  std::vector<std::string> heard() const {
    return {command, motion_command, motion_gear, motion_stream, request, transfer};
  }
};

struct BridgeOptions {
  std::int64_t session = 0;
  bool observe = false;
  std::string interface;  ///< reported in status_t
  std::string realtime;   ///< reported in status_t
  bool motions = true;    ///< runs the motions of motion_command_t
  bool typed = true;      ///< also publishes a typed message for each node, see TypedChannels
  /// Paths of the EDS and DCF files on this machine, in the order of the nodes of the plan.
  std::vector<std::string> device_files{};
};

/// The work of the front thread: turns images, states and events of a MasterRun into messages, and
/// messages into set-points and requests. Reads clocks and never waits.
class Bridge {
 public:
  /// `announce` receives all events and notices of the gateway, right after LCM.
  Bridge(MasterRun& master, Transport& transport, const Clocks& clocks, BridgeOptions options,
         NoticeSink announce);

  /// Registers a guest that receives images, events and the replies to requests with
  /// FrontGuest::mark. The guest must outlive this object.
  void register_guest(FrontGuest& guest) noexcept { guest_ = &guest; }
  /// Commands outputs as a command_t computed in this cycle would. Returns false if the command is
  /// refused. Refusals are reported; commands that may have waited during a gap are only counted.
  bool command(const std::string& sender, std::span<const SignalIndex> signals,
               std::span<const std::int64_t> values);
  /// Checks whether this thread did not run for a while. Messages that waited meanwhile have no
  /// effect.
  void notice_gap();
  /// Returns the number of gaps in which this thread did not run. Set-points that waited are
  /// discarded.
  std::uint64_t gaps() const noexcept { return gaps_; }
  /// Returns the number of gaps that were so long that waiting requests are discarded too.
  std::uint64_t long_gaps() const noexcept { return long_gaps_; }
  Time newest_gap() const noexcept { return gap_.length(); }
  Time newest_long_gap() const noexcept { return gap_.newest_long().length; }
  /// Does everything that can be done now. Returns true if there was an image.
  bool serve();
  /// Returns true if events or replies of the bus thread are, or may be, left for the next round.
  bool has_unsent_reports() const noexcept { return replies_left_ || events_left_; }
  /// Returns the latest time of the next serve() call: at once if anything is left over, otherwise
  /// when status_t, pdo_status_t, layout_t or timing_t is due.
  Time next_message() const noexcept;
  /// Takes an event of the bus thread or of the diagnostic socket.
  void announce(const Event& event);
  /// Takes a notice from elsewhere. Sends it to LCM and to `announce`, unless there are too many of
  /// its kind.
  void announce(Notice notice);

  /// Sets the function that begins a recording for a `record` request, or returns why it can't
  /// begin. After it has begun a recording, answer() must follow. Without this function, the bridge
  /// refuses `record` requests.
  void record_with(Requests::Begin record) { record_ = std::move(record); }
  /// Answers a request that has begun.
  void answer(const request_t& request, bool good, const std::string& text);

  const StatusSnapshot& status() const noexcept { return snapshot_; }
  std::uint64_t images() const noexcept { return images_; }
  std::uint64_t commands_taken() const noexcept { return commands_.taken(); }
  std::uint64_t commands_refused() const noexcept { return commands_.refused(); }
  /// Returns the refused commands by reason, in the order of CommandRefusal.
  const auto& refusals() const noexcept { return commands_.refusals(); }
  /// Returns the number of messages that could not be decoded.
  std::uint64_t damaged() const noexcept { return damaged_count_; }
  const Histogram& sync_to_lcm() const noexcept { return sync_to_lcm_; }
  const Channels& channels() const noexcept { return channels_; }

 private:
  bool publish_images();
  void publish_image(const ImageView& image, bool typed);
  /// Returns the present cycle by the clock; this includes cycles whose images were not seen yet.
  std::uint64_t cycle_at(Time now) const noexcept;
  bool take_at(const command_t& command, Time now, std::optional<std::size_t> only_node = {});
  /// Returns true if a command may have waited during a gap: the transports may still hold messages
  /// from the gap, or the command was computed from an image from before the end of the gap.
  /// `cycle` is the cycle of that image.
  bool waited(std::int64_t cycle, Time now) const noexcept;
  void publish_outputs();
  /// Returns why a request is too old to be executed; empty if it is not too old.
  std::string age_error(std::int64_t utime, Time now) const;
  void take_events();
  void take_event(const Event& event);
  /// Returns the number of events lost in the bus thread and on the way from it.
  std::uint64_t events_lost() const noexcept;
  void report_lost_events();
  void warn(const std::string& kind, const std::string& text);
  Notice fallback_notice(Event event) const;
  void take_replies(const FrontBudget& budget);
  void take_reply(const Reply& reply);
  void serve_requests();
  void read_status();
  void take_messages();
  void on_message(std::string_view channel, Bytes data);
  void on_command(Bytes data);
  void on_typed(std::string_view channel, Bytes data);
  void take_command(const command_t& command, std::optional<std::size_t> only_node = {});
  /// A message about motions: motion_command_t, motion_gear_t or motion_stream_t.
  template <class T>
  void on_motion(std::string_view channel, Bytes data);
  void serve_motions();
  void tell_released(const CommandContext& context);
  CommandContext context_at(Time now, std::optional<std::size_t> only_node = {}) const noexcept;
  void on_request(Bytes data);
  void send(Notice notice);
  void answer_history(const request_t& request);
  void answer_device_file(const request_t& request);
  void on_transfer(Bytes data);
  void report_damaged(const std::string& channel, DecodeFault fault);
  /// A message that is published periodically.
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
  std::int64_t wall_microseconds(Time monotonic) const noexcept;
  template <class T>
  void publish(const std::string& channel, const T& message) {
    transport_.publish(channel, encode(message, buffer_));
  }
  /// Publishes a message of this session that was made at `when`.
  template <class T>
  void publish(const std::string& channel, T&& message, Time when) {
    message.utime = wall_microseconds(when);
    message.session = options_.session;
    publish(channel, message);
  }

  MasterRun& master_;
  Transport& transport_;
  const Clocks& clocks_;
  FrontClock clock_ = [this] { return clocks_.now(); };
  BridgeOptions options_;
  NoticeSink announce_;
  FrontGuest* guest_ = nullptr;
  Requests::Begin record_;
  Channels channels_;
  ImageMessages image_messages_;
  std::optional<TypedChannels> typed_;
  std::vector<layout_t> layout_messages_;
  std::vector<speed_axes_t> speed_messages_;
  StatusMessages status_messages_;
  TimingMessages timing_messages_;
  // Time from SYNC until the image, with its typed messages, is handed over.
  Histogram sync_to_lcm_;
  Commands commands_;
  MotionCommands motions_;
  MotionSnapshot motion_reports_;
  Requests requests_;
  Transfers transfers_;
  PdoOutages outages_;
  NoticeLimit limit_;
  std::string stop_text_;  ///< one line for each axis that the newest stop did not confirm
  Time stop_reported_{};   ///< end of the newest stop that was reported
  std::uint64_t damaged_count_ = 0;
  RateLimit damaged_{std::chrono::seconds{10}};
  std::vector<std::byte> buffer_;
  StatusSnapshot snapshot_;
  std::uint64_t status_version_ = 0;  ///< version of the status in `snapshot_`
  std::vector<PdoMark> marks_;        // marks of the newest image
  EmcyLog emcy_log_;
  Time wall_minus_monotonic_{};
  std::array<PeriodicState, 4> states_{{{std::chrono::seconds{1}, &Bridge::publish_layout},
                                        {std::chrono::milliseconds{100}, &Bridge::publish_status},
                                        {std::chrono::milliseconds{500}, &Bridge::publish_pdos},
                                        {std::chrono::seconds{1}, &Bridge::publish_timing}}};
  /// Longest time for which a due state waits for an image that it can follow.
  Time image_wait_;
  std::uint64_t cycle_ = 0;  // cycle of the newest image
  Time sync_time_{};         // SYNC of the newest image
  Time judged_{};            // time at which the age of the oldest staged command was checked
  FrontGap gap_;
  std::uint64_t gaps_ = 0;
  std::uint64_t long_gaps_ = 0;
  bool skip_images_ = false;  // images that waited during a gap are skipped
  /// The first cycle whose commands count: that of the first image whose SYNC came after the newest
  /// gap.
  std::uint64_t first_cycle_ = 0;
  std::uint64_t images_ = 0;
  std::uint64_t events_lost_reported_ = 0;
  bool outputs_staged_ = false;
  bool replies_left_ = false;    // the budget of this round ended before the replies
  bool transfers_left_ = false;  // steps of transfers are left over
  bool events_left_ = false;
  std::int64_t instance_;        // instance of the daemon itself as a sender of commands
  std::uint64_t own_cycle_ = 0;  // cycle of the daemon's own newest command
};

}  // namespace takt
