#include "master/core/network/stop_requests.hpp"

#include <algorithm>
#include <array>
#include <utility>

#include "master/core/node/boot_value.hpp"
#include "master/wire/bytes.hpp"
#include "master/wire/sdo_abort.hpp"

namespace takt {
namespace {

constexpr Time poll_pause = std::chrono::milliseconds{10};
/// The shortest time between two writes to an axis. In between, its values are read.
constexpr Time write_pause = std::chrono::milliseconds{100};

bool keeps_alive(const NodePlan& node) {
  return std::ranges::any_of(node.boot_plan.steps, [](const BootStep& step) {
    return step.action == BootAction::await_alive;
  });
}

/// Returns true if the step writes a value that makes the device supervise the master.
bool arms(const BusPlan& plan, const BootStep& step) {
  if (step.action != BootAction::write && step.action != BootAction::write_if_differs) return false;
  const bool any = !all_zero(step.value);
  switch (step.object.index) {
    case 0x1016: {
      const bool whole = step.object.sub != 0 && step.value.size() == 4;
      return whole && std::to_integer<unsigned>(step.value[2]) == plan.master_id.value();
    }
    case 0x1006:
      return any && plan.cycle.makes_sync();
    case 0x100C:
    case 0x100D:
      return any;
    default:
      return false;
  }
}

/// Returns true if the device type names a profile that is not the one of drives. A device without
/// a standard profile (0) may be a drive. A device with several logical devices may also contain a
/// drive, because its device type is that of the first logical device. CiA 301, 0x1000.
bool is_no_drive(std::uint32_t device_type) noexcept {
  constexpr std::uint32_t several_devices = 0xFFFF;
  const std::uint32_t profile = device_type & 0xFFFF;
  return profile != 402 && profile != 0 && device_type >> 16U != several_devices;
}

}  // namespace

StopRequests::StopRequests(const BusPlan& plan)
    : plan_{plan},
      axes_{OrderedStop::axes_of(plan)},
      polls_(axes_.size()),
      failed_(plan.nodes.size()),
      refused_boots_(plan.nodes.size()) {
  if (plan.stop_disarm != StopDisarm::sdo) return;
  for (std::size_t i = 0; i < plan.nodes.size(); ++i) {
    const NodePlan& node = plan.nodes[i];
    if (node.boot && !keeps_alive(node)) add_jobs(plan, static_cast<std::uint8_t>(i));
  }
}

void StopRequests::add_jobs(const BusPlan& plan, std::uint8_t node_index) {
  const NodePlan& node = plan.nodes[node_index];
  const std::size_t first = jobs_.size();
  for (const BootStep& step : node.boot_plan.steps) {
    const auto same = [&](const Job& job) {
      return job.node_index == node_index && job.object == step.object;
    };
    if (!arms(plan, step) || std::ranges::any_of(jobs_, same)) continue;
    const auto place = static_cast<std::uint16_t>(&step - node.boot_plan.steps.data());
    if (jobs_.size() == first) {
      jobs_.push_back({.node = node.id.value(), .node_index = node_index, .step = place});
    }
    jobs_.push_back({.node = node.id.value(),
                     .node_index = node_index,
                     .object = step.object,
                     .bytes = static_cast<std::uint8_t>(step.value.size()),
                     .step = place,
                     .timeout = node.sdo_timeout_of(step.object)});
  }
}

void StopRequests::begin() noexcept {
  for (std::size_t i = 0; i < polls_.size(); ++i) {
    const bool by_position = axes_[i].position && !axes_[i].velocity;
    polls_[i] = {
        .waiting = polls_[i].waiting, .by_position = by_position, .asked = polls_[i].asked};
  }
  std::ranges::fill(failed_, std::uint8_t{0});
  next_job_ = answered_ = turn_ = 0;
}

void StopRequests::ask(std::size_t axis, Word word, std::int64_t value) noexcept {
  constexpr std::array<std::uint16_t, 5> bases{0x6041, 0x606C, 0x6064, 0x6040, 0x1000};
  const StopAxis& of = axes_[axis];
  const auto kind = static_cast<std::size_t>(word);
  const bool writes = word == Word::control;
  const int offset = word == Word::device_type ? 0 : of.number * axis_step;
  asked_ = axis;
  request_.id = mark | axis << 8U | kind;
  request_.kind = writes ? RequestKind::sdo_download : RequestKind::sdo_upload;
  request_.node = plan_.nodes[of.node_index].id.value();
  request_.object = {static_cast<std::uint16_t>(bases[kind] + offset), 0};
  request_.size = writes ? 2 : 0;
  request_.timeout = Time{};
  store_le(std::span{request_.data}, static_cast<std::uint16_t>(value));
}

bool StopRequests::read_next(std::size_t axis, bool needs_word, bool needs_motion) noexcept {
  Poll& poll = polls_[axis];
  if (!needs_word && !needs_motion) return false;
  poll.word_next = needs_word && (!needs_motion || !poll.word_next);
  const Word motion = poll.by_position ? Word::position : Word::velocity;
  ask(axis, poll.word_next ? Word::status : motion);
  return true;
}

/// Makes the next request of an axis. A controlword that no PDO carries has priority.
bool StopRequests::due_of_axis(std::size_t axis, Time now, const OrderedStop& stop,
                               bool exchanging) noexcept {
  const StopAxis& of = axes_[axis];
  const AxisStop& state = stop.axis(axis);
  if (polls_[axis].waiting || now < polls_[axis].due || state.settled()) return false;
  if (polls_[axis].type == TypeQuery::due) {
    ask(axis, Word::device_type);
    return true;
  }
  const auto word = stop.controlword(axis);
  const bool by_sdo = !of.controlword || !exchanging;
  const bool may_write = state.seen() && now >= polls_[axis].write_again;
  if (by_sdo && may_write && word && *word != polls_[axis].written) {
    polls_[axis].writing = *word;
    ask(axis, Word::control, *word);
    return true;
  }
  return read_next(axis, !exchanging || stop.needs_word(axis, now),
                   !exchanging || stop.needs_motion(axis, now));
}

/// Returns true if the device is armed, so that it supervises the master. A ready node is armed. A
/// node whose boot has failed is armed if the boot has reached the step that arms it, unless the
/// device has refused the write in this very step. A lost node, or one that has given no sign of
/// life, does not count as armed.
bool StopRequests::armed(const Job& job, const NodeStatus& node) const noexcept {
  if (node.boot == BootState::ready) return true;
  const bool answered = node.boot_letter != 'B' || node.nmt != NmtState::unknown;
  const bool refused = refused_boots_[job.node_index] && job.step == node.boot_step;
  return node.boot == BootState::failed && answered && job.step <= node.boot_step && !refused;
}

/// Makes the next write that disarms a device. The writes of a device are made one after the other.
/// If the device does not accept one, its other writes are left out.
const Request* StopRequests::next_job(std::span<const NodeStatus> nodes) noexcept {
  for (; next_job_ < jobs_.size(); ++next_job_, ++answered_) {
    const Job& job = jobs_[next_job_];
    const bool is_armed = armed(job, nodes[job.node_index]);
    if (job.object == ObjectKey{} && !is_armed) failed_[job.node_index] = 1;
    if (!is_armed || failed_[job.node_index] != 0) continue;
    const bool nmt = job.object == ObjectKey{};
    request_.id = mark | of_job | next_job_;
    request_.kind = nmt ? RequestKind::nmt : RequestKind::sdo_download;
    request_.command = NmtCommand::enter_preoperational;
    request_.node = job.node;
    request_.object = job.object;
    request_.size = job.bytes;
    request_.timeout = job.timeout;
    std::ranges::fill(std::span{request_.data}.first(job.bytes), std::byte{0});
    return &request_;
  }
  return nullptr;
}

const Request* StopRequests::next(Time now, const OrderedStop& stop,
                                  std::span<const bool> exchanging,
                                  std::span<const NodeStatus> nodes) noexcept {
  if (stop.stage() == StopStage::disarm) return next_job(nodes);
  if (stop.stage() == StopStage::running || stop.axes_done()) return nullptr;
  for (std::size_t left = polls_.size(); left != 0; --left) {
    turn_ = turn_ + 1 < polls_.size() ? turn_ + 1 : 0;
    if (!due_of_axis(turn_, now, stop, exchanging[axes_[turn_].node_index])) continue;
    polls_[turn_].asked = now;
    return &request_;
  }
  return nullptr;
}

void StopRequests::submitted() noexcept {
  if ((request_.id & of_job) != 0) {
    ++next_job_;
  } else {
    polls_[asked_].waiting = true;
  }
}

bool StopRequests::take(const Reply& reply, Time now, OrderedStop& stop) noexcept {
  if ((reply.id & of_job) != 0) {
    ++answered_;
    const Job& job = jobs_[reply.id & 0xFFFF];
    if (reply.fault == SdoFault::none) return true;
    refused_ = job;
    refusal_ = 0;
    if (reply.fault == SdoFault::aborted_by_device) refusal_ = std::int64_t{reply.abort_code};
    if (reply.fault == SdoFault::timeout) refusal_ = -job.timeout.count();
    return std::exchange(failed_[job.node_index], std::uint8_t{1}) != 0;
  }
  const std::size_t axis = reply.id >> 8U & 0xFFFF;
  polls_[axis].waiting = false;
  polls_[axis].due = now + poll_pause;
  const auto word = static_cast<Word>(reply.id & 0xFF);
  if (reply.fault != SdoFault::none) {
    if (word == Word::control) polls_[axis].write_again = now + write_pause;
    take_fault(axis, word, reply, stop);
  } else {
    take_value(axis, word, reply, stop);
  }
  return true;
}

void StopRequests::take_fault(std::size_t axis, Word word, const Reply& reply,
                              OrderedStop& stop) noexcept {
  Poll& poll = polls_[axis];
  if (word == Word::device_type) poll.type = TypeQuery::answered;
  if (reply.fault != SdoFault::aborted_by_device) return;
  if (word == Word::velocity) poll.by_position = true;
  if (word == Word::position) poll.by_position = false;
  if (word != Word::status) return;
  stop.take_refusal(axis, reply.abort_code);
  if (reply.abort_code != abort_code::no_object) return;
  if (stop.axis(axis).state() == AxisState::asked) return stop.take_absence(axis);
  if (poll.type == TypeQuery::not_needed) poll.type = TypeQuery::due;
}

std::optional<StopRequests::AxisWord> StopRequests::statusword_of(const Reply& reply) noexcept {
  const bool word = (reply.id & of_job) == 0 && static_cast<Word>(reply.id & 0xFF) == Word::status;
  if (!word || reply.fault != SdoFault::none || reply.size != 2) return std::nullopt;
  return AxisWord{.axis = reply.id >> 8U & 0xFFFF,
                  .value = load_le<std::uint16_t>(std::span{reply.data})};
}

void StopRequests::take_value(std::size_t axis, Word word, const Reply& reply,
                              OrderedStop& stop) noexcept {
  Poll& poll = polls_[axis];
  if (word == Word::control) {
    poll.written = poll.writing;
    return;
  }
  if (word == Word::device_type) poll.type = TypeQuery::answered;
  if (reply.size == 0 || reply.size > 4) return;
  const auto raw = load_le<std::uint32_t>(std::span{reply.data}.first(reply.size));
  if (word == Word::device_type) {
    if (reply.size == 4 && is_no_drive(raw)) stop.take_absence(axis);
    return;
  }
  const int unused = 32 - 8 * static_cast<int>(reply.size);
  const auto value = static_cast<std::int32_t>(raw << unused) >> unused;
  AxisSample sample;
  if (word == Word::status) {
    sample.statusword = raw & 0xFFFF;
    sample.word_asked = poll.asked;
  } else {
    sample.motion_asked = poll.asked;
  }
  if (word == Word::velocity) sample.velocity = value;
  if (word == Word::position) sample.position = value;
  stop.take(axis, sample);
}

}  // namespace takt
