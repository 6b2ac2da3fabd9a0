#pragma once
#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

#include "eds_parser/table/bus_plan.hpp"
#include "master/core/event_queue.hpp"
#include "master/core/output_limits.hpp"
#include "master/core/pdo_fields.hpp"
#include "master/core/pdo_inputs.hpp"
#include "master/core/pdo_status.hpp"
#include "master/core/set_point.hpp"
#include "master/core/working_image.hpp"

namespace takt {

/// When a set of outputs is packed.
struct OutputMoment {
  std::uint64_t cycle = 0;
  Time now{};
};

/// Set-points -> RPDO frames. An RPDO goes out only when its node exchanges PDOs and each of its
/// signals has been commanded, has a safe value or is seeded by its feedback. Types 1..240 go out
/// each n-th cycle, the others when a value has changed; that event is kept until its frame went
/// out. One set of commands that changes several synchronous RPDOs sends them in one cycle, those
/// of type n out of turn: all act at the next SYNC. A command outside the limits of its output
/// isn't sent; the outputs of its node take their fallback at once, and until a later command to
/// that output is inside, or none has come for its time to live, all commands to the node are
/// dropped. Bus thread only.
class PdoOutputs {
 public:
  /// Keeps references to all four.
  PdoOutputs(const BusPlan& plan, WorkingImage& image, const PdoInputs& inputs, EventQueue& events);

  /// From now on the node's RPDOs may go out; commands given before are forgotten.
  void open(std::size_t node_index, std::span<const SetPoint> set_points) noexcept;
  void shut(std::size_t node_index) noexcept;
  /// Limits that the node has told in its boot, after open(). Each is told, the implausible ones
  /// are ignored.
  void learn(std::size_t node_index, std::span<const LimitReading> readings,
             OutputMoment moment) noexcept;

  /// The frames that are due, in the order of the table; valid until the next call. `set_points`
  /// holds one per output signal.
  std::span<const Frame> pack(std::span<const SetPoint> set_points, OutputMoment moment) noexcept;
  /// Not all that were packed fit: the synchronous ones, which belong together, and of the others
  /// as many as have room in so many bits; those take turns. None where the synchronous ones alone
  /// do not fit. Valid until the next pack().
  std::span<const Frame> pack_less(std::int64_t bits,
                                   std::int64_t (*bits_of)(const Frame&) noexcept) noexcept;
  /// The first `count` of the packed frames went out; the others are tried again.
  void sent(std::size_t count, OutputMoment moment) noexcept;

  /// A command from within the bus thread; `signal` counts in the whole layout.
  void command(SignalIndex signal, std::int64_t value, std::uint32_t time_to_live,
               OutputMoment moment) noexcept;

  /// Ordered stop, or SYNC is lost: every commanded output takes its fallback. Commands are refused
  /// from now on: none of them acts later.
  void fall_back() noexcept;
  /// The end of fall_back(): each output keeps its fallback until its next command.
  void hear_again() noexcept { stopping_ = false; }
  /// It has a value worth sending.
  bool known(SignalIndex signal) const noexcept { return outputs_[output_of(signal)].known; }
  /// It was commanded, and its fallback is in force.
  bool fallen(SignalIndex signal) const noexcept { return outputs_[output_of(signal)].fallen; }
  /// Ordered stop, or the loss of a node: this value from now on; commands are refused.
  void force(SignalIndex signal, std::int64_t value) noexcept;
  /// The next command is heard again, none from before.
  void release(SignalIndex signal) noexcept;

  /// Commands that the last pack() saw for the first time.
  std::uint32_t fresh_commands() const noexcept { return fresh_commands_; }
  /// Every signal of this RPDO has a value worth sending.
  bool ready(std::size_t row) const noexcept { return rows_[row].ready; }
  RpdoStatus status(std::size_t row) const noexcept {
    return {.sent = rows_[row].sent, .ready = rows_[row].ready};
  }

  template <class Archive>
  void keep(Archive& state) noexcept {
    state(outputs_, rows_, begun_, limits_, turn_, stopping_);
    state.position(next_event_, rows_.size());
  }

 private:
  static constexpr std::uint64_t no_end = ~0ULL;
  std::uint32_t awaited_start(const PdoRow& pdo) const noexcept;

  static constexpr std::uint8_t partial_limit = 10;  ///< cycles until `outputs_held` is told

  struct Output {
    std::uint64_t expires = no_end;  ///< cycle in which the command is too old
    std::uint32_t generation = 0;
    std::uint32_t limit = 0;  ///< configured time to live in cycles; 0: none
    bool known = false;       ///< has a value worth sending
    bool commanded = false;   ///< and that value was commanded
    bool fallen = false;      ///< its fallback is in force
    bool forced = false;
    bool released = false;  ///< it fell because its sender gave it up

    template <class Archive>
    void keep(Archive& state) noexcept {
      state(expires, generation, limit, known, commanded, fallen, forced, released);
    }
  };
  struct Row {
    std::uint64_t word = 0;  ///< as it was packed last
    Time last_sent{};
    std::uint64_t last_cycle = 0;
    std::uint32_t sent = 0;
    bool open = false;
    bool ready = false;
    bool ever_sent = false;  ///< since it was opened
    bool pending = false;    ///< it has changed and was not sent since
    bool due = false;        ///< its turn has come and it was not sent since
    bool held_told = false;
    std::uint8_t partial = 0;
    SignalIndex first_fallen = 0;
    SignalIndex first_risen = 0;
    std::uint16_t fallen = 0;  ///< signals that fell back in this pack
    std::uint16_t risen = 0;   ///< signals that left their fallback in this pack

    template <class Archive>
    void keep(Archive& state) noexcept {
      state(word, last_sent, last_cycle, sent, open, ready, ever_sent, pending, due, held_told,
            partial);
    }
  };
  struct Built {
    std::uint64_t word = 0;
    bool lacking = false;
    bool commanded = false;  ///< by a command that was not seen before
  };

  Built build(std::size_t row, std::span<const SetPoint> set_points, OutputMoment moment) noexcept;
  void take(Output& output, SignalIndex signal, const SetPoint& set_point,
            OutputMoment moment) noexcept {
    const std::uint32_t limit = limit_of(output, set_point);
    output.generation = set_point.generation;
    output.expires =
        limit == 0 ? no_end : moment.cycle + limit - std::min(limit, age(set_point, moment));
    output.known = true;
    output.commanded = true;
    output.fallen = false;
    output.released = false;
    image_.values[signal] = set_point.value;
  }
  /// The shorter of the two times to live that are set; 0: none is.
  static std::uint32_t limit_of(const Output& output, const SetPoint& set_point) noexcept {
    const bool configured = output.limit != 0 && output.limit < set_point.time_to_live;
    return set_point.time_to_live == 0 || configured ? output.limit : set_point.time_to_live;
  }
  /// The command has outlived its time before it was seen here. One without limit has a second.
  bool is_late(const Output& output, const SetPoint& set_point,
               OutputMoment moment) const noexcept {
    const std::uint32_t waited = age(set_point, moment);
    if (waited == 0) [[likely]] {
      return false;
    }
    const std::uint32_t limit = limit_of(output, set_point);
    if (limit != 0) return waited >= limit;
    return waited >= std::chrono::seconds{1} / plan_.cycle.period;
  }
  /// Its sender has given the output up.
  void let_go(Output& output, SignalIndex signal) noexcept;
  /// Cycles since the front thread judged the command's age; 0 where that was since the outputs
  /// before these, which may have been a quarter of a period early.
  std::uint32_t age(const SetPoint& set_point, OutputMoment moment) const noexcept {
    const Time period = plan_.cycle.period;
    const Time passed = moment.now - set_point.when - period / 4;
    if (passed < period) [[likely]] {
      return 0;
    }
    constexpr std::int64_t most = 0xFFFF'FFFF;
    return static_cast<std::uint32_t>(std::min(passed / period, most));
  }
  bool refuses(const Output& output) const noexcept { return stopping_ || output.forced; }

  // Limits: pdo_outputs_limits.cpp.
  /// Drops what is outside its limits from the commands that are new in this pack.
  void check_limits(std::span<const SetPoint> set_points, OutputMoment moment) noexcept;
  /// The same of one command from within the bus thread. False: it is dropped.
  bool within_limits(SignalIndex signal, std::int64_t value, OutputMoment moment) noexcept;
  /// This command is new, and is to be taken where it is inside.
  bool is_news(const Output& output, const SetPoint& set_point,
               OutputMoment moment) const noexcept {
    return set_point.generation != output.generation && set_point.time_to_live != output_released &&
           !refuses(output) && !is_late(output, set_point, moment);
  }
  bool limited_row_open(std::size_t place) const noexcept;
  Obeying obeying(SignalIndex signal) const noexcept;
  void judge_news(std::size_t place, std::span<const SetPoint> set_points,
                  OutputMoment moment) noexcept;
  /// False: outside, its node has taken its fallback.
  bool judge(std::size_t place, std::int64_t value, std::int64_t mode,
             OutputMoment moment) noexcept;
  void drop_node(std::size_t node_index) noexcept;
  /// Ends the refusal of commands to an output, once the fallback of its node was sent.
  void forgive(std::size_t place, OutputMoment moment) noexcept;
  void note_limited(std::size_t row, std::uint64_t cycle) noexcept;
  void fall(Output& output, SignalIndex signal) noexcept;
  void seed(Output& output, SignalIndex signal) noexcept;
  /// Builds all rows. True: one set of commands has changed several synchronous ones.
  bool build_all(std::span<const SetPoint> set_points, OutputMoment moment) noexcept;
  bool due(std::size_t row, OutputMoment moment) const noexcept;
  const Frame& add_frame(std::size_t row) noexcept;
  void tell_changes(std::size_t row, bool lacking, OutputMoment moment) noexcept;
  void tell(EventKind kind, std::size_t row, std::int64_t value, OutputMoment moment,
            std::uint32_t detail = 0) noexcept;
  std::size_t output_of(SignalIndex signal) const noexcept { return signal - inputs_count_; }

  const BusPlan& plan_;
  WorkingImage& image_;
  const PdoInputs& inputs_;
  EventQueue& events_;
  std::size_t inputs_count_;
  std::vector<FieldProgram> fields_;
  OutputLimits limits_;
  std::vector<Output> outputs_;
  std::vector<Row> rows_;
  std::vector<std::uint8_t> begun_;  ///< per node: an output is commanded, seeds no longer follow
  std::vector<Frame> frames_;
  std::vector<std::uint16_t> packed_;
  std::size_t packed_count_ = 0;
  std::size_t next_event_ = 0;  ///< row whose turn it is where not all fit
  std::uint64_t turn_ = 0;      ///< packs so far: the raster of types 2..240, one for all rows
  std::uint32_t fresh_commands_ = 0;
  bool stopping_ = false;
};

}  // namespace takt
