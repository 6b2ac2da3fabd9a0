#include "master/gateway/bridge.hpp"

namespace takt {

template <class T>
void Bridge::on_motion(std::string_view channel, Bytes data) {
  const auto command = decode<T>(data);
  if (!command) return report_damaged(std::string{channel}, command.error());
  if (!options_.motions) {
    return warn("motion_refused", "taktd runs no motions: it was started with --no-motions");
  }
  const Time now = clocks_.now();
  if (waited(command->cycle, now)) return commands_.discard();
  motions_.take(*command, context_at(now));
}

template void Bridge::on_motion<motion_command_t>(std::string_view channel, Bytes data);
template void Bridge::on_motion<motion_gear_t>(std::string_view channel, Bytes data);
template void Bridge::on_motion<motion_stream_t>(std::string_view channel, Bytes data);

/// Plans the motions that wait for the newest reports, and publishes the reports once a command has
/// come. The bus thread hands over the end of an order before the report of that cycle. Therefore
/// the reports are copied first: the ends of all orders in them can then be taken.
void Bridge::serve_motions() {
  if (!options_.motions) return;
  motions_.begin();
  if (!motions_.watches()) return;
  const Time now = clocks_.now();
  const std::uint64_t published = motion_reports_.cycle;
  master_.motions(motion_reports_);
  for (motion::MotionEnd end; master_.take(end);) motions_.take(end, context_at(now));
  motions_.serve(context_at(now));
  if (motion_reports_.cycle == published) return;
  motions_.observe(motion_reports_, context_at(now));
  if (!motions_.active()) return;
  for (motion_t& part : motions_.messages()) publish(channels_.motion, part, now);
}

/// Reports to the bus thread which senders have released their nodes. This happens before the
/// outputs are released, and before a later message of the same sender takes the node again.
void Bridge::tell_released(const CommandContext& context) {
  if (motions_.watches()) motions_.serve(context);
}

}  // namespace takt
