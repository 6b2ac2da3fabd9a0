#include "master/gateway/command/transfers.hpp"

#include <algorithm>
#include <chrono>
#include <fmt/format.h>
#include <utility>

#include "eds_parser/table/waits.hpp"
#include "eds_parser/values/name_of.hpp"
#include "master/lcm/messages.hpp"

namespace takt {
namespace {

/// This bit is set in the id of each request that the class Transfers makes, and clear in the id of
/// each request that the class Requests makes.
constexpr std::uint64_t transfer_mark = std::uint64_t{1} << 63;
constexpr Time progress_period = std::chrono::milliseconds{500};
/// Bytes by which one step enlarges the buffer of an upload before the request is submitted.
constexpr std::size_t room_step = 64U << 10;

}  // namespace

Transfers::Transfers(const BusPlan& plan, RequestsOptions options, std::span<SdoTransfer> buffers,
                     Sinks sinks)
    : plan_{plan}, options_{options}, sinks_{std::move(sinks)} {
  for (SdoTransfer& buffer : buffers) jobs_.emplace_back().buffer = &buffer;
}

Transfers::Job* Transfers::find(const transfer_t& message) {
  const auto job = std::ranges::find_if(jobs_, [&](const Job& candidate) {
    return candidate.stage != Stage::free && candidate.id == message.id &&
           candidate.sender == message.sender;
  });
  return job == jobs_.end() ? nullptr : &*job;
}

void Transfers::take(const transfer_t& message, Time now) {
  Job* const job = find(message);
  if (job == nullptr) return begin(message, now);
  job->heard = now;
  if (message.action == "more" && job->stage == Stage::done) return ask_for_parts(*job, message);
  if (message.action == "end" && !job->submitted) return forget(*job);
  if (message.action == "data") fill(*job, message);
  if (message.action == "abort") cancel(*job, "the program that requested the transfer aborted it");
  sinks_.state(state_of(*job));
}

void Transfers::take_old(const transfer_t& message, const std::string& why) {
  if (message.action == "end") return;
  if (const Job* const job = find(message)) return sinks_.state(state_of(*job));
  refuse(message, why);
}

void Transfers::begin(const transfer_t& message, Time now) {
  if (message.action != "download" && message.action != "upload") {
    if (message.action == "end") return;
    return refuse(message,
                  "taktd does not know this transfer; it may have been silent for too long");
  }
  auto request = translate(message);
  if (!request) return refuse(message, request.error());
  const auto job = std::ranges::find(jobs_, Stage::free, &Job::stage);
  if (job == jobs_.end()) {
    return refuse(
        message, fmt::format("{} file transfers run already, which is the maximum; try again later",
                             jobs_.size()));
  }
  *job = {.buffer = job->buffer,
          .stage = Stage::filling,
          .sender = message.sender,
          .id = message.id,
          .request = *request,
          .total = static_cast<std::size_t>(message.total),
          .heard = now,
          .reported = now};
  job->request.id = transfer_mark | next_id_++;
  job->request.transfer = job->buffer;
  job->buffer->data.reserve(job->total);
  job->buffer->done.store(0);
  job->buffer->announced.store(0);
  job->buffer->cancel.store(false);
  if (job->request.kind == RequestKind::sdo_upload || message.total == 0) {
    job->stage = Stage::running;
    step(*job);
  }
  sinks_.state(state_of(*job));
}

std::expected<Request, std::string> Transfers::translate(const transfer_t& message) const {
  using Error = std::unexpected<std::string>;
  if (message.schema != message_schema) return Error{schema_refusal(message.schema)};
  if (message.session != 0 && message.session != options_.session) {
    return Error{"the transfer is for another session of taktd"};
  }
  if (options_.observe) return Error{observing_text};
  std::string obstacle = object_obstacle(plan_, message.node_id, message.index, message.sub);
  if (!obstacle.empty()) return Error{std::move(obstacle)};
  if (message.total < 0 || static_cast<std::uint64_t>(message.total) > most_bytes) {
    return Error{fmt::format("a file has at most {} bytes", most_bytes)};
  }
  if (message.sender.size() > 64) return Error{"the sender's name is longer than 64 bytes"};
  return Request{
      .kind = message.action == "upload" ? RequestKind::sdo_upload : RequestKind::sdo_download,
      .node = static_cast<std::uint8_t>(message.node_id),
      .object = {static_cast<std::uint16_t>(message.index), static_cast<std::uint8_t>(message.sub)},
      .timeout = request_timeout(message.timeout_ms)};
}

/// Takes parts only in order. The transfer_state_t after each part gives the offset at which the
/// sender has to continue.
void Transfers::fill(Job& job, const transfer_t& message) {
  const std::size_t size = message.data.size();
  if (job.stage != Stage::filling || job.submitted) return;
  if (message.offset != static_cast<std::int64_t>(job.received)) return;
  if (size > part_bytes || size > job.total - job.received) return;
  const Bytes bytes = std::as_bytes(std::span{message.data});
  job.buffer->data.insert(job.buffer->data.end(), bytes.begin(), bytes.end());
  job.received += size;
  if (job.received == job.total) submit(job);
}

/// Submits the request. If the bus thread has no room, on_time() tries again.
void Transfers::submit(Job& job) {
  job.submitted = sinks_.submit(job.request);
  job.stage = Stage::running;
}

/// Selects the parts that on_time() sends. They replace the parts of an earlier "more" message.
void Transfers::ask_for_parts(Job& job, const transfer_t& message) {
  const std::size_t total = job.buffer->data.size();
  if (message.offset < 0 || static_cast<std::uint64_t>(message.offset) > total) {
    return sinks_.state(state_of(job));
  }
  const auto wanted = static_cast<std::size_t>(std::clamp<std::int64_t>(
      message.total, 1, static_cast<std::int64_t>(parts_at_once * part_bytes)));
  job.part_begin = static_cast<std::size_t>(message.offset);
  job.part_end = std::min(total, job.part_begin + wanted);
}

void Transfers::send_part(Job& job) {
  transfer_state_t part = state_of(job);
  const std::size_t size = std::min(part_bytes, job.part_end - job.part_begin);
  part.offset = static_cast<std::int64_t>(job.part_begin);
  part.size = static_cast<std::int32_t>(size);
  const auto bytes = octets(job.buffer->data).subspan(job.part_begin, size);
  part.data.assign(bytes.begin(), bytes.end());
  job.part_begin += size;
  sinks_.state(part);
}

bool Transfers::finish(const Reply& reply) {
  if ((reply.id & transfer_mark) == 0) return false;
  const auto job = std::ranges::find_if(jobs_, [&](const Job& candidate) {
    return candidate.submitted && candidate.request.id == reply.id;
  });
  if (job == jobs_.end()) return true;
  job->submitted = false;
  const bool good = reply.fault == SdoFault::none;
  job->stage = good ? Stage::done : Stage::failed;
  job->abort_code = reply.abort_code;
  if (job->text.empty() && !good) {
    job->text = reply.fault == SdoFault::too_long
                    ? fmt::format("the object is longer than the {} requested bytes", job->total)
                    : fault_text(reply.fault, reply.abort_code, reply.silence);
  }
  if (good && job->request.kind == RequestKind::sdo_upload) {
    job->buffer->data.resize(job->buffer->done.load());
  }
  sinks_.state(state_of(*job));
  return true;
}

void Transfers::cancel(Job& job, const std::string& why) {
  if (job.stage != Stage::filling && job.stage != Stage::running) return;
  job.text = why;
  job.buffer->cancel.store(true);
  if (!job.submitted) job.stage = Stage::failed;
}

void Transfers::forget(Job& job) {
  SdoTransfer* const buffer = job.buffer;
  buffer->data = {};
  job = {};
  job.buffer = buffer;
}

bool Transfers::on_time(Time now, const FrontBudget& budget) {
  for (Job& job : jobs_) watch(job, now);
  for (std::size_t idle = 0; idle < jobs_.size();) {
    Job& job = jobs_[turn_];
    turn_ = (turn_ + 1) % jobs_.size();
    idle = step(job) ? 0 : idle + 1;
    if (idle == 0 && !budget.is_left()) return true;
  }
  return false;
}

void Transfers::watch(Job& job, Time now) {
  if (job.stage == Stage::free) return;
  if (now - job.heard > waits::transfer_silence) {
    cancel(job, "the program that requested the transfer has gone away");
    if (!job.submitted) forget(job);
    return;
  }
  if (job.stage != Stage::running || now - job.reported < progress_period) return;
  job.reported = now;
  sinks_.state(state_of(job));
}

/// Enlarges the buffer for an upload, hands a request to the bus thread, or sends a part. Returns
/// false if there is nothing to do now.
bool Transfers::step(Job& job) {
  if (job.stage == Stage::done && job.part_begin < job.part_end) {
    send_part(job);
    return true;
  }
  if (job.stage != Stage::running || job.submitted) return false;
  std::vector<std::byte>& data = job.buffer->data;
  data.resize(std::min(job.total, data.size() + room_step));
  if (data.size() == job.total) submit(job);
  return data.size() != job.total || job.submitted;
}

transfer_state_t Transfers::state_of(const Job& job) const {
  static constexpr std::string_view stages[] = {"free", "filling", "running", "done", "failed"};
  transfer_state_t state = state_for(job.sender, job.id);
  state.stage = name_of(job.stage, stages);
  const bool has_all = job.request.kind == RequestKind::sdo_download || job.stage == Stage::done;
  const std::size_t size = job.stage == Stage::done
                               ? job.buffer->data.size()
                               : job.total;  // the length of an upload is known once it is done
  state.total = has_all ? static_cast<std::int64_t>(size)
                        : job.buffer->announced.load(std::memory_order_relaxed);
  state.received = static_cast<std::int64_t>(job.received);
  state.done = job.buffer->done.load(std::memory_order_relaxed);
  state.abort_code = job.abort_code;
  state.text = job.text;
  return state;
}

transfer_state_t Transfers::state_for(const std::string& sender, std::int64_t id) const {
  transfer_state_t state{};
  state.schema = message_schema;
  state.session = options_.session;
  state.id = id;
  state.sender = sender.substr(0, 64);
  return state;
}

void Transfers::refuse(const transfer_t& message, std::string why) {
  transfer_state_t state = state_for(message.sender, message.id);
  state.stage = "failed";
  state.text = std::move(why);
  sinks_.state(state);
}

}  // namespace takt
