#pragma once
#include <algorithm>
#include <array>
#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

#include "eds_parser/table/bus_plan.hpp"
#include "master/core/event_queue.hpp"
#include "master/core/pdo/output_limits.hpp"
#include "master/core/pdo/pdo_fields.hpp"
#include "master/core/pdo/pdo_inputs.hpp"
#include "master/core/pdo/refused_outputs.hpp"
#include "master/core/pdo/working_image.hpp"
#include "master/core/pdo_status.hpp"
#include "master/core/set_point.hpp"

namespace takt {

/// The moment at which a set of outputs is packed.
struct OutputMoment {
  std::uint64_t cycle = 0;
  Time now{};
};

/// Makes RPDO frames from set-points. An RPDO is sent only if its node exchanges PDOs and each of
/// its signals has a value: a command, a safe value, or the value of its feedback. An RPDO of the
/// transmission type n in 1..240 is sent in each n-th cycle. The others are sent when a value has
/// changed; such an event is kept until its frame was sent. If one set of commands changes several
/// synchronous RPDOs, all of them are sent in the same cycle, even if it is not the n-th one, so
/// that all take effect at the next SYNC.
///
/// A command outside the limits of its output is not sent, and the outputs of its node take their
/// fallback at once. After that, all commands to the node are dropped until a later command to this
/// output is inside the limits, or until no command has come for the time to live. Bus thread only.
class PdoOutputs {
 public:
  /// Keeps references to all four arguments.
  PdoOutputs(const BusPlan& plan, WorkingImage& image, const PdoInputs& inputs, EventQueue& events);

  /// Permits the RPDOs of the node from now on. Commands from the time before have no effect.
  void open(std::size_t node_index, std::span<const SetPoint> set_points) noexcept;
  /// Ends the RPDOs of the node.
  void shut(std::size_t node_index) noexcept;
  /// Takes the limits that the boot has read from the node; call this after open(). Each limit is
  /// reported, and implausible ones are ignored.
  void learn(std::size_t node_index, std::span<const LimitReading> readings,
             OutputMoment moment) noexcept;

  /// Makes the frames that are due, in the order of the table. They are valid until the next call.
  /// `set_points` holds one set-point for each output signal.
  std::span<const Frame> pack(std::span<const SetPoint> set_points, OutputMoment moment) noexcept;
  /// Returns true if a value has changed and is not sent yet, for example because of an inhibit
  /// time.
  bool pending() const noexcept {
    return std::ranges::any_of(rows_, [](const Row& r) { return r.open && r.ready && r.pending; });
  }
  /// Returns a selection of the packed frames that fits into `bits`. Call it if they do not all
  /// fit. The selection has all synchronous frames, because they belong together, and as many of
  /// the others as fit. The first of the others that does not fit is the first choice of the next
  /// call. Returns an empty span if the synchronous frames alone do not fit. The span is valid
  /// until the next pack().
  std::span<const Frame> pack_less(std::int64_t bits,
                                   std::int64_t (*bits_of)(const Frame&) noexcept) noexcept;
  /// Notes that the first `count` of the packed frames were sent; the others are tried again.
  void sent(std::size_t count, OutputMoment moment) noexcept;

  /// Takes a command from within the bus thread. `signal` is the index in the whole layout;
  /// `time_to_live` is in cycles, 0 means the configured one.
  void command(SignalIndex signal, std::int64_t value, std::uint32_t time_to_live,
               OutputMoment moment) noexcept;

  /// Lets every commanded output take its fallback, for an ordered stop or the loss of SYNC.
  /// Commands are refused from now on, and none of them takes effect later.
  void fall_back() noexcept;
  /// Ends fall_back(), so that commands are accepted again. Each output keeps its fallback until
  /// its next command.
  void hear_again() noexcept { stopping_ = false; }
  /// Returns true if the output has a value that can be sent.
  bool known(SignalIndex signal) const noexcept { return outputs_[output_of(signal)].known; }
  /// Returns true if nobody has commanded the output so far, and its value is that of its feedback.
  bool is_seeded(SignalIndex signal) const noexcept {
    const Output& output = outputs_[output_of(signal)];
    const Signal& what = plan_.layout.signals[signal];
    return output.known && !output.commanded && what.seeded_from && !what.safe_value;
  }
  /// Returns true if the output was commanded and its fallback is effective.
  bool fallen(SignalIndex signal) const noexcept { return outputs_[output_of(signal)].fallen; }
  /// Forces this value from now on and refuses commands to the output, for an ordered stop or the
  /// loss of a node.
  void force(SignalIndex signal, std::int64_t value) noexcept;
  /// Ends force(). The output accepts its next command, but not those that came while force() was
  /// effective.
  void release(SignalIndex signal) noexcept;

  /// Commands an output from a motion of the bus thread. Until release_lead(), commands of others
  /// to this output are refused, and none of them takes effect later. Releases of the outputs of
  /// the same axis, and of outputs of the node that belong to no axis, take effect after
  /// release_lead(). Returns false if the value was not taken, because it is outside the limits or
  /// the output is_overruled().
  bool lead(SignalIndex signal, std::int64_t value, OutputMoment moment) noexcept;
  /// Returns true if lead() takes no value, whatever it is, because an ordered stop, an NMT command
  /// or the loss of a node commands the output.
  bool is_overruled(SignalIndex signal) const noexcept {
    return stopping_ || outputs_[output_of(signal)].forced;
  }
  /// Commands once more the value that the last lead() has commanded. The value is not checked: the
  /// axis stands still at once, even if the limits would require that it slows down first. Does
  /// nothing if the ordered stop, force() or the fallback determines the value.
  void hold(SignalIndex signal, OutputMoment moment) noexcept;
  /// Notes that the motion of this output stood still during `cycles` cycles before this one. They
  /// do not count for the limits of its next step.
  void pass_over(SignalIndex signal, std::uint64_t cycles, OutputMoment moment) noexcept;
  /// Sets the target position of an axis that is enabled but stopped by a Halt, under the
  /// conditions of trail(). The next step is measured from this value.
  bool settle(SignalIndex signal, std::int64_t value, OutputMoment moment) noexcept;
  /// Ends lead(). The output keeps its value and accepts its next command.
  void release_lead(SignalIndex signal) noexcept { set_led(signal, false); }
  /// Sets the value of an output of a motion without checking it: a target position that has no
  /// effect because its axis is not enabled, or the velocity offset 0 of an axis whose target
  /// position stands still. This is no command. Returns false and changes nothing if the output
  /// has no value yet, or if the ordered stop, force() or a fallback determines it.
  bool trail(SignalIndex signal, std::int64_t value) noexcept;
  /// Keeps the command of the output valid in this cycle, if it was valid before.
  void keep_alive(SignalIndex signal, OutputMoment moment) noexcept {
    Output& output = outputs_[output_of(signal)];
    if (output.commanded && !output.fallen) {
      output.expires = std::max(output.expires, moment.cycle + 1);
    }
  }

  /// Returns the number of commands that the last pack() has seen for the first time.
  std::uint32_t fresh_commands() const noexcept { return fresh_commands_; }
  /// Returns true if every signal of this RPDO has a value that can be sent.
  bool ready(std::size_t row) const noexcept { return rows_[row].ready; }
  /// Returns the status of an RPDO; `row` is the index into PdoTable::rpdos.
  RpdoStatus status(std::size_t row) const noexcept {
    return {.sent = rows_[row].sent, .ready = rows_[row].ready};
  }

  template <class Archive>
  void keep(Archive& state) noexcept {
    state(outputs_, rows_, begun_, led_, limits_, refusals_, turn_, stopping_);
    state.position(next_event_, rows_.size());
  }

 private:
  static constexpr std::uint64_t no_end = ~0ULL;
  std::uint32_t awaited_start(const PdoRow& pdo) const noexcept;

  static constexpr std::uint8_t partial_limit = 10;  ///< cycles until `outputs_held` is reported

  struct Output {
    std::uint64_t expires = no_end;  ///< cycle in which the command expires
    std::uint32_t generation = 0;
    std::uint32_t limit = 0;  ///< configured time to live in cycles; 0 means no limit
    bool known = false;       ///< the output has a value that can be sent
    bool commanded = false;   ///< that value was commanded
    bool fallen = false;      ///< the fallback is effective
    bool forced = false;
    bool led = false;  ///< see lead()
    /// The fallback is effective because the sender has released the output.
    bool released = false;

    template <class Archive>
    void keep(Archive& state) noexcept {
      state(expires, generation, limit, known, commanded, fallen, forced, led, released);
    }
  };
  struct Row {
    std::uint64_t word = 0;  ///< data of the last packed frame
    Time last_sent{};
    std::uint64_t last_cycle = 0;
    std::uint32_t sent = 0;
    bool open = false;
    bool ready = false;
    bool ever_sent = false;  ///< a frame was sent since open()
    bool pending = false;    ///< a value has changed and is not sent yet
    bool due = false;        ///< the frame is due and is not sent yet
    bool held_reported = false;
    std::uint8_t partial = 0;
    SignalIndex first_fallen = 0;
    SignalIndex first_risen = 0;
    std::uint16_t fallen = 0;  ///< signals that fell back in this pack
    std::uint16_t risen = 0;   ///< signals that left their fallback in this pack

    template <class Archive>
    void keep(Archive& state) noexcept {
      state(word, last_sent, last_cycle, sent, open, ready, ever_sent, pending, due, held_reported,
            partial);
    }
  };
  struct Built {
    std::uint64_t word = 0;
    bool lacking = false;
    bool commanded = false;  ///< a signal of the row has a new command
  };

  /// `prompt` is prompt_after() of this moment.
  Built build(std::size_t row, std::span<const SetPoint> set_points, OutputMoment moment,
              Time prompt) noexcept;
  [[gnu::cold, gnu::noinline]] bool hear(Row& row, Output& output, SignalIndex signal,
                                         const SetPoint& set_point, OutputMoment moment) noexcept;
  void take(Output& output, SignalIndex signal, const SetPoint& set_point,
            OutputMoment moment) noexcept {
    output.generation = set_point.generation;
    accept(output, limit_of(output, set_point.time_to_live), age(set_point, moment), moment);
    image_.values[signal] = set_point.value;
  }
  /// Notes that a command is accepted. It expires after `limit` cycles, of which `waited` are over;
  /// with a limit of 0 the command does not expire.
  static void accept(Output& output, std::uint32_t limit, std::uint32_t waited,
                     OutputMoment moment) noexcept {
    output.expires = limit == 0 ? no_end : moment.cycle + limit - std::min(limit, waited);
    output.known = true;
    output.commanded = true;
    output.fallen = false;
    output.released = false;
  }
  /// Returns the shorter one of the time to live of the output and that of the command. 0 means
  /// that neither is set.
  static std::uint32_t limit_of(const Output& output, std::uint32_t time_to_live) noexcept {
    const bool configured = output.limit != 0 && output.limit < time_to_live;
    return time_to_live == 0 || configured ? output.limit : time_to_live;
  }
  /// Returns true if the command has expired before the bus thread has seen it. A command without
  /// limit may wait for one second.
  bool is_late(const Output& output, const SetPoint& set_point,
               OutputMoment moment) const noexcept {
    const std::uint32_t waited = age(set_point, moment);
    if (waited == 0) [[likely]] {
      return false;
    }
    const std::uint32_t limit = limit_of(output, set_point.time_to_live);
    if (limit != 0) return waited >= limit;
    return waited >= std::chrono::seconds{1} / plan_.cycle.period;
  }
  /// Lets the output take its fallback, because its sender has released it.
  void release_output(Output& output, SignalIndex signal) noexcept;
  /// Returns the number of cycles since the front thread has determined the age of the command. The
  /// result is 0 if this was after the previous outputs, which may have been made up to a quarter
  /// of a period early.
  std::uint32_t age(const SetPoint& set_point, OutputMoment moment) const noexcept {
    const Time period = plan_.cycle.period;
    const Time passed = moment.now - set_point.when - period / 4;
    if (passed < period) [[likely]] {
      return 0;
    }
    constexpr std::int64_t most = 0xFFFF'FFFF;
    return static_cast<std::uint32_t>(std::min(passed / period, most));
  }
  /// The age() of a command is 0 if the front thread has determined it after this time.
  Time prompt_after(OutputMoment moment) const noexcept {
    const Time period = plan_.cycle.period;
    return moment.now - period / 4 - period;
  }
  bool refuses(const Output& output) const noexcept {
    return stopping_ || output.forced || output.led;
  }
  void set_led(SignalIndex signal, bool led) noexcept {
    Output& output = outputs_[output_of(signal)];
    if (output.led == led) return;
    output.led = led;
    const Signal& what = plan_.layout.signals[signal];
    std::uint8_t& count = led_[what.node_index][axis_of(what.object).value_or(0)];
    count = static_cast<std::uint8_t>(led ? count + 1 : count - 1);
  }
  bool release_waits(const Output& output, SignalIndex signal) const noexcept;

  [[gnu::noinline]] void command_limited(SignalIndex signal, std::int64_t value,
                                         std::uint32_t time_to_live, OutputMoment moment) noexcept;

  // These functions are in pdo_outputs_limits.cpp.
  /// Drops those new commands of this pack that are outside their limits.
  void check_limits(std::span<const SetPoint> set_points, OutputMoment moment) noexcept;
  /// Checks one command from within the bus thread. Returns false if it is dropped.
  bool within_limits(SignalIndex signal, std::int64_t value, OutputMoment moment) noexcept;
  /// Returns true if this command is new and will be accepted if it is inside its limits.
  bool is_new_command(const Output& output, const SetPoint& set_point,
                      OutputMoment moment) const noexcept {
    return set_point.generation != output.generation && set_point.time_to_live != output_released &&
           !refuses(output) && !is_late(output, set_point, moment);
  }
  bool has_new_commands(std::span<const SetPoint> set_points) const noexcept;
  bool limited_row_open(std::size_t place) const noexcept;
  Obeying obeying(SignalIndex signal) const noexcept;
  void judge_commands(std::size_t place, std::span<const SetPoint> set_points,
                      OutputMoment moment) noexcept;
  struct Newest {
    std::int64_t value = 0;
    bool is_new = false;  ///< a new command of this pack
  };
  Newest newest(std::optional<SignalIndex> signal, std::span<const SetPoint> set_points,
                OutputMoment moment) const noexcept;
  void admit_commands(std::size_t place, std::span<const SetPoint> set_points,
                      OutputMoment moment) noexcept;
  bool awaits_sending(SignalIndex signal) const noexcept;
  void take_back(SignalIndex signal, std::int64_t before) noexcept;
  AxisCommand command_with(std::size_t place, SignalIndex signal,
                           std::int64_t value) const noexcept;
  bool covered(std::size_t place, std::int64_t mode, bool target_is_new) const noexcept;
  bool suits_targets(SignalIndex signal, std::int64_t value, OutputMoment moment) noexcept;
  /// The output for which a refusal is reported, and its raw value.
  struct Cause {
    SignalIndex signal = 0;
    std::int64_t value = 0;
  };
  /// Returns false if the command is outside its limits; the outputs of its node have then taken
  /// their fallback.
  bool judge(std::size_t place, const AxisCommand& command, Cause cause,
             OutputMoment moment) noexcept;
  void drop_node(std::size_t node_index) noexcept;
  /// Ends the refusal of commands to an output, after the fallback of its node was sent.
  void end_refusal(std::size_t place, OutputMoment moment) noexcept;
  void note_limited(std::size_t row, std::uint64_t cycle) noexcept;
  void fall(Output& output, SignalIndex signal) noexcept;
  void seed(Output& output, SignalIndex signal) noexcept;
  /// Builds all rows. Returns true if one set of commands has changed several synchronous rows.
  bool build_all(std::span<const SetPoint> set_points, OutputMoment moment) noexcept;
  bool due(std::size_t row, OutputMoment moment) const noexcept;
  const Frame& add_frame(std::size_t row) noexcept;
  void report_changes(std::size_t row, bool lacking, OutputMoment moment) noexcept;
  void announce(EventKind kind, std::size_t row, std::int64_t value, OutputMoment moment,
                std::uint32_t detail = 0) noexcept;
  std::size_t output_of(SignalIndex signal) const noexcept { return signal - inputs_count_; }

  const BusPlan& plan_;
  WorkingImage& image_;
  const PdoInputs& inputs_;
  EventQueue& events_;
  std::size_t inputs_count_;
  std::vector<FieldProgram> fields_;
  OutputLimits limits_;
  RefusedOutputs refusals_;
  std::vector<Output> outputs_;
  std::vector<Row> rows_;
  /// By node: an output was commanded, so the other outputs no longer take the values of their
  /// feedback.
  std::vector<std::uint8_t> begun_;
  /// By node and axis: number of outputs that motions command.
  std::vector<std::array<std::uint8_t, most_axes>> led_;
  std::vector<Frame> frames_;
  std::vector<std::uint16_t> packed_;
  std::size_t packed_count_ = 0;
  std::size_t next_event_ = 0;  ///< event-driven row that is first if not all frames fit
  /// Number of packs so far; the common phase of types 2..240 for all rows.
  std::uint64_t turn_ = 0;
  std::uint32_t fresh_commands_ = 0;
  bool stopping_ = false;
};

}  // namespace takt
