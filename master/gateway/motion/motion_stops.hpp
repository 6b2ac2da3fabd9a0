#pragma once
#include <cstdint>
#include <vector>

#include "eds_parser/table/motion_axes.hpp"
#include "master/gateway/command/commands.hpp"
#include "master/gateway/motion/motion_job.hpp"

namespace takt {

/// Hands stops to the bus thread, and reports to it which senders have lost their nodes. A stop is
/// never lost: if the bus thread can't take it now, serve() tries again. All calls come from the
/// front thread.
class MotionStops {
 public:
  /// Keeps references to the first two arguments. `axes` are the motion_axes() of the plan.
  MotionStops(const std::vector<MotionAxis>& axes, const Commands& commands, SubmitMotion submit)
      : axes_{axes},
        commands_{commands},
        submit_{std::move(submit)},
        owners_(axes.size()),
        waiting_(axes.size()) {}

  void stop(std::size_t axis) {
    waiting_[axis] =
        !submit_({.kind = motion::MessageKind::stop, .axis = static_cast<std::uint8_t>(axis)});
  }
  /// Notes that this motion has begun.
  void began(const motion::TaggedOrder& motion) {
    Owner& owner = owners_[motion.order.axis];
    if (owner.order == motion.order.id) return;
    owner = {
        .order = motion.order.id, .instance = motion.tag.instance, .number = motion.order.sender};
  }
  void serve(const CommandContext& context) {
    for (std::size_t i = 0; i < axes_.size(); ++i) {
      if (waiting_[i]) stop(i);
      tell_lost(i, context);
    }
  }

 private:
  /// The sender of a motion: the instance that holds the node, and its number for the bus thread.
  struct Owner {
    std::uint32_t order = 0;
    std::int64_t instance = 0;  ///< 0: nobody, or the bus thread knows that it has left
    std::uint8_t number = 0;
    bool has_left = false;  ///< the bus thread does not know yet that the sender has lost the node
  };

  void tell_lost(std::size_t axis, const CommandContext& context) {
    Owner& owner = owners_[axis];
    if (owner.instance == 0) return;
    const bool holds = commands_.holds(axes_[axis].node_index, owner.instance, context.cycle);
    owner.has_left = owner.has_left || !holds;
    if (!owner.has_left) return;
    const bool told = submit_({.kind = motion::MessageKind::left,
                               .sender = owner.number,
                               .axis = static_cast<std::uint8_t>(axis)});
    if (told) owner = {.order = owner.order};
  }

  const std::vector<MotionAxis>& axes_;
  const Commands& commands_;
  SubmitMotion submit_;
  std::vector<Owner> owners_;  ///< sender of the motion that began last, indexed by axis
  std::vector<bool> waiting_;  ///< a stop waits to be handed over, indexed by axis
};

}  // namespace takt
