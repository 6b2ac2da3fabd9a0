#pragma once
#include <cstdint>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "eds_parser/table/motion_axes.hpp"
#include "master/gateway/command/commands.hpp"
#include "master/gateway/motion/motion_job.hpp"
#include "master/gateway/motion/motion_messages.hpp"
#include "master/gateway/notice/notice.hpp"
#include "master/lcm/rate_limit.hpp"

namespace takt {

/// Reports to applications and users how motions have ended. The same notice is sent at most once a
/// second. All calls come from the front thread.
class MotionAnswers {
 public:
  /// Keeps references to `plan` and `axes`. `axes` are the motion_axes() of the plan.
  MotionAnswers(const BusPlan& plan, const std::vector<MotionAxis>& axes, NoticeSink announce)
      : plan_{plan}, axes_{axes}, announce_{std::move(announce)}, shown_(axes.size()) {}

  /// Refuses a message. `axes` are its axes, as indices into motion_axes().
  void refuse(const MotionName& motion, std::span<const std::size_t> axes,
              const MotionRefusal& refusal, const CommandContext& context);
  void refuse(const MotionJob& job, const MotionRefusal& refusal, const CommandContext& context);
  /// Reports that the motion with this id was stopped.
  void stopped(std::size_t axis, std::int32_t id, const motion::Stop& stop,
               const CommandContext& context);
  /// Reports to users that a homing run has ended, or that the home position is lost.
  void homing_changed(std::size_t axis, motion::HomingState before, motion::HomingState now,
                      const CommandContext& context);
  void ended(std::size_t axis, std::int32_t id, ShownMotion::Ended ended) {
    shown_[axis].ended_id = id;
    shown_[axis].ended = ended;
  }
  /// Notes that the motion with this id runs on the axis; 0 means that no motion runs.
  void runs(std::size_t axis, std::int32_t id) { shown_[axis].id = id; }

  /// Returns what motion_t reports about the motions of each axis.
  const std::vector<ShownMotion>& shown() const noexcept { return shown_; }

 private:
  void announce_refusal(const MotionName& motion, const MotionRefusal& refusal,
                        const CommandContext& context);
  void announce(const std::string& kind, const std::string& text, std::optional<std::size_t> axis,
                const CommandContext& context, Weight weight = Weight::warning);
  std::string name_of(std::size_t axis) const;

  const BusPlan& plan_;
  const std::vector<MotionAxis>& axes_;
  NoticeSink announce_;
  RateLimit reported_{std::chrono::seconds{1}};
  std::vector<ShownMotion> shown_;
};

}  // namespace takt
