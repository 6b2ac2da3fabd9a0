#include "master/black_box/replay.hpp"

#include <memory>

#include "master/black_box/difference_text.hpp"
#include "master/rt/bus_loop.hpp"

namespace takt {
namespace {

class Replay {
 public:
  Replay(const BusPlan& plan, const LoadedRecording& recording,
         const std::function<void(const Decision&)>& announce)
      : plan_{plan},
        recording_{recording},
        announce_{announce},
        port_{recording.parts, plan.layout.outputs()},
        exchange_{std::make_unique<Exchange>(plan)},
        loop_{plan, port_, {port_, *exchange_}, {.observe = recording.head.observe}} {}

  ReplayOutcome run() {
    if (!begin()) return std::move(outcome_);
    while (!port_.over() && !loop_.done() && !outcome_.difference) {
      loop_.cycle();
      end_cycle();
    }
    if (!outcome_.difference) look_at_end();
    return std::move(outcome_);
  }

 private:
  /// Returns false if the recording begins in the middle of the run of another plan or of another
  /// version of takt.
  bool begin() {
    if (recording_.checkpoint.empty()) {
      loop_.start();
      return true;
    }
    if (!loop_.resume(recording_.checkpoint)) {
      outcome_.difference =
          "the recording begins in the middle of a run, and the network file has other nodes or "
          "PDOs, or this is another version of takt: the checkpoint can't be used";
      return false;
    }
    end_cycle();
    return true;
  }

  void end_cycle() {
    ImageView image;
    exchange_->images.take_newest(image);
    compare_events();
    ++outcome_.cycles;
  }

  /// Compares the events of one cycle. If the port has found a difference in this cycle, that
  /// difference comes first, and the first event that differs shows its consequence.
  void compare_events() {
    std::string event_differs;
    for (Event event; exchange_->events.pop(event);) {
      const Decision decision = to_decision(plan_, event);
      announce_(decision);
      if (event_differs.empty()) event_differs = compare(decision);
    }
    if (port_.difference()) {
      outcome_.difference = difference_text(*port_.difference(), recording_.logs);
      if (!event_differs.empty())
        *outcome_.difference += "\nthe difference leads to " + event_differs;
    } else if (!event_differs.empty()) {
      outcome_.difference = event_differs;
    }
  }

  /// Compares a decision with the recording. Returns an empty text if they are equal.
  std::string compare(const Decision& decision) {
    if (outcome_.decisions == recording_.decisions.size()) return surplus_text(decision);
    const Decision& recorded = recording_.decisions[outcome_.decisions];
    if (decision != recorded) return decision_text(recorded, decision);
    ++outcome_.decisions;
    return {};
  }

  void look_at_end() {
    if (outcome_.decisions < recording_.decisions.size()) {
      outcome_.difference = lack_text(recording_.decisions[outcome_.decisions]);
    } else if (!port_.over()) {
      outcome_.difference = "the master has stopped, but the recording continues";
    }
  }

  const BusPlan& plan_;
  const LoadedRecording& recording_;
  const std::function<void(const Decision&)>& announce_;
  ReplayPort port_;
  std::unique_ptr<Exchange> exchange_;
  BusLoop<ReplayPort, ReplayedLink> loop_;
  ReplayOutcome outcome_;
};

}  // namespace

ReplayOutcome replay(const BusPlan& plan, const LoadedRecording& recording,
                     const std::function<void(const Decision&)>& announce) {
  return std::make_unique<Replay>(plan, recording, announce)->run();
}

}  // namespace takt
