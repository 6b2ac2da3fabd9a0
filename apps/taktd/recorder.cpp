#include "apps/taktd/recorder.hpp"

#include <utility>

#include "master/explain/boot_report.hpp"
#include "master/lcm/printable_text.hpp"
#include "master/linux/clock.hpp"

namespace takt {
namespace {

constexpr std::size_t most_waiting = 16;

}  // namespace

std::expected<void, std::string> Recorder::open(const BlackBoxOptions& options, const BusPlan& plan,
                                                RecordingHead head) {
  auto box = BlackBox::open(
      options, plan, std::move(head),
      [this](const std::string& sentence, const std::string& file) { on_written(sentence, file); });
  if (!box) return std::unexpected{std::move(box.error())};
  box_ = std::move(*box);
  return {};
}

void Recorder::attach(Bridge& bridge) {
  bridge_ = &bridge;
  bridge.record_with([this](const request_t& request) { return on_request(request); });
}

void Recorder::on_fault(const Notice& notice) {
  const bool fallback = notice.kind == name(EventKind::fallback_begun) ||
                        notice.kind == name(EventKind::limit_exceeded);
  if (!box_ || (notice.weight != Weight::error && !fallback)) return;
  box_->on_fault(notice.kind, notice.node, notice.text, monotonic_now());
}

std::optional<std::string> Recorder::on_request(const request_t& request) {
  if (!box_) {
    return "the black box is off: start taktd with --black-box DIR, or write `black_box: {folder: "
           "DIR}` in the network file";
  }
  if (waiting_.size() == most_waiting) {
    return "too many requests came at once; send the request again later";
  }
  waiting_.push_back(request);
  box_->on_request("requested by " + printable_text(request.sender.substr(0, 64)), monotonic_now());
  return std::nullopt;
}

void Recorder::record(const std::string& why, Time now) {
  if (box_) box_->on_request(why, now);
}

void Recorder::serve(Time now) {
  if (box_) box_->serve(now);
}

bool Recorder::finish(const std::string& reason, Time limit) {
  const bool through = !box_ || box_->finish(reason, limit);
  if (!through) say_(Weight::warning, "black box: the last recording could not be written in time");
  answer_all(false, "taktd has ended");
  return through;
}

void Recorder::finish_running(const std::string& reason, Time limit) {
  if (box_ && !box_->finish_running(reason, limit)) {
    say_(Weight::warning,
         "black box: the last recording, at the end of the run, could not be written completely in "
         "time");
  }
  answer_all(false, "taktd has ended");
}

/// `file` is empty if the recording could not be written.
void Recorder::on_written(const std::string& text, const std::string& file) {
  const Weight weight = file.empty() ? Weight::warning : Weight::note;
  if (bridge_ == nullptr) {
    say_(weight, text);
  } else {
    bridge_->announce(Notice{.when = monotonic_now(),
                             .kind = file.empty() ? "not_recorded" : "recorded",
                             .weight = weight,
                             .text = text});
  }
  answer_all(!file.empty(), file.empty() ? text : file);
}

void Recorder::answer_all(bool good, const std::string& text) {
  for (const request_t& request : std::exchange(waiting_, {})) {
    bridge_->answer(request, good, text);
  }
}

}  // namespace takt
