#include "master/gateway/motion/motion_text.hpp"

namespace takt {
namespace {

std::string_view text_of(motion::Defect defect) noexcept {
  using enum motion::Defect;
  switch (defect) {
    case not_finite:
      return "a number of the command is infinite or NaN";
    case velocity_limits:
    case acceleration_limits:
    case jerk_limit:
      return "a limit is not above 0";
    case target_velocity:
      return "the velocity is above its limit";
    case target_acceleration:
    case velocity_before_target:
      return "the target can't be reached within the limits";
    case position_range:
      return "the axis would leave its range of positions";
    case common_duration:
      return "no duration was found that is possible for all axes";
    case precision:
      return "the numbers of the command differ by too many powers of ten";
  }
  return "the motion is impossible";
}

}  // namespace

std::string_view text(const motion::PlanRefusal& refusal) noexcept {
  using enum motion::PlanFault;
  switch (refusal.fault) {
    case no_axis:
      return "an axis is named twice";
    case no_report:
      return "the bus thread has not reported the state of the axes";
    case busy:
      return "another motion of the axis is about to begin";
    case not_enabled:
      return "the drive does not follow set-points: it must be in Operation enabled, without a "
             "Halt and in cyclic synchronous position mode, and the RPDO of its target position "
             "must have a value for each of its objects and be sent";
    case stopping:
      return "the axis is stopping, and must come to rest first";
    case foreign:
      return "the axis runs another motion";
    case streaming:
      return "the axis follows a stream: stop it first";
    case geared:
      return "the axis follows a gear, which has to end first";
    case moving:
      return "the axis moves: a stream begins at rest";
    case ring:
      return "the axis can't follow its leader, because the leader follows this axis, directly or "
             "through other axes";
    case other_start:
      return "the first point of the stream is not at the position of the axis, with velocity 0";
    case too_long:
      return "the motion, or the start of the jog, would take too long";
    case impossible:
      return text_of(refusal.defect);
  }
  return "the motion is impossible";
}

std::string_view text(motion::StreamDefect defect) noexcept {
  using enum motion::StreamDefect;
  switch (defect) {
    case not_finite:
      return "a number is infinite, NaN or too large";
    case not_later:
      return "its time is not later than that of the point before";
    case position:
      return "the axis would leave its range of positions";
    case velocity:
      return "the velocity would exceed its limit on the way to it";
    case acceleration:
      return "the acceleration would exceed its limit on the way to it";
    case jerk:
      return "the jerk would exceed its limit on the way to it";
    case stop_position:
      return "the axis could not stop inside its range of positions on the way to it";
    case stop_velocity:
      return "the velocity would exceed its limit in a stop on the way to it";
  }
  return "it is not valid";
}

std::string_view text(motion::Outcome outcome) noexcept {
  using enum motion::Outcome;
  switch (outcome) {
    case not_powered:
      return text(motion::PlanRefusal{.fault = motion::PlanFault::not_enabled});
    case is_stopping:
      return text(motion::PlanRefusal{.fault = motion::PlanFault::stopping});
    case sender_was_silent:
      return "the sender was silent for longer than the timeout";
    case no_stop:
      return "with the limits of the gear, the axis could not stop from its present motion inside "
             "its range and in time";
    case too_late:
      return "taktd could not plan the motion in time";
    case group_incomplete:
      return "another axis of the group can't begin";
    case other_start:
      return "the axis is not in the state in which the motion begins";
    default:
      return "the motion is not valid";
  }
}

std::string_view text(motion::StopCause cause) noexcept {
  using enum motion::StopCause;
  switch (cause) {
    case none:
      break;
    case sender_silent:
      return "its sender was silent for longer than the timeout";
    case sender_left:
      return "its sender does not hold the node any longer";
    case disabled:
      return "the drive has left Operation enabled";
    case inactive:
      return "the drive has ended interpolated position mode: bit 12 of its statusword is 0";
    case fault:
      return "the drive is in fault";
    case node_lost:
      return "the node is lost";
    case halted:
      return "the Halt bit in the controlword of the drive is set";
    case no_statusword:
      return "the statusword of the drive is missing";
    case following_error:
      return "the following error is above its limit";
    case points_ended:
      return "the points of its stream have ended while it moved";
    case end_of_range:
      return "the end of the range of positions is near";
    case limit:
      return "a set-point was outside the limits of the network file";
    case no_sync:
      return "SYNC was missing in several periods";
    case not_sent:
      return "its set-points were not sent in several cycles";
    case ordered_stop:
      return "taktd stops";
    case nmt_command:
      return "an NMT command stops the drive";
    case application:
      return "its sender has stopped it";
    case leader_lost:
      return "the leader of its gear has failed, or its position is missing";
    case phase_error:
      return "the phase error of its gear is above its limit";
  }
  return "the reason is unknown";
}

std::string_view text(motion::HomingState homing) noexcept {
  using enum motion::HomingState;
  switch (homing) {
    case none:
      return "the axis is not homed, which `homing:` of the network file requires before it goes "
             "to a position: home it first; move_by and jog are possible without homing";
    case runs:
      return "the homing of the axis has not ended";
    case failed:
      return "the last homing of the axis has failed, and `homing:` of the network file requires "
             "it before the axis goes to a position: home it first; move_by and jog are possible "
             "without homing";
    case homed:
      break;
  }
  return "the axis is homed";
}

}  // namespace takt
