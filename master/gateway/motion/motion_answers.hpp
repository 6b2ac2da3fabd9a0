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

/// Tells applications and people how motions have ended. The same notice comes at most once in a
/// second. Front thread.
class MotionAnswers {
 public:
  /// `axes` are the motion_axes() of the plan. Keeps references to both.
  MotionAnswers(const BusPlan& plan, const std::vector<MotionAxis>& axes, NoticeSink announce)
      : plan_{plan}, axes_{axes}, announce_{std::move(announce)}, shown_(axes.size()) {}

  /// Refuses a message. `axes` are the positions of its axes in motion_axes().
  void refuse(const MotionName& motion, std::span<const std::size_t> axes,
              const MotionRefusal& refusal, const CommandContext& context);
  void refuse(const MotionJob& job, const MotionRefusal& refusal, const CommandContext& context);
  /// The motion with this id of the axis was stopped.
  void stopped(std::size_t axis, std::int32_t id, const motion::Stop& stop,
               const CommandContext& context);
  /// Tells people that a homing run has ended, or that the home position is lost.
  void homing_changed(std::size_t axis, motion::HomingState before, motion::HomingState now,
                      const CommandContext& context);
  void ended(std::size_t axis, std::int32_t id, ShownMotion::Ended ended) {
    shown_[axis].ended_id = id;
    shown_[axis].ended = ended;
  }
  /// The motion with this id runs; 0 for none.
  void runs(std::size_t axis, std::int32_t id) { shown_[axis].id = id; }

  /// What motion_t says, by axis.
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
