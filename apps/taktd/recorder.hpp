#pragma once
#include <deque>
#include <expected>
#include <functional>
#include <memory>
#include <optional>
#include <string>
#include <takt/request_t.hpp>

#include "master/black_box/black_box.hpp"
#include "master/gateway/bridge.hpp"
#include "master/gateway/notice/notice.hpp"

namespace takt {

/// Owns the black box of a bus and triggers its recordings on faults and on requests over LCM. The
/// recorder answers each request once, with the file or with the reason why there is none. Used
/// only by the front thread.
class Recorder {
 public:
  using Say = std::function<void(Weight weight, const std::string& sentence)>;

  explicit Recorder(Say say) : say_{std::move(say)} {}

  /// Starts recording. The error is a sentence for the user. `plan` must outlive the recorder.
  std::expected<void, std::string> open(const BlackBoxOptions& options, const BusPlan& plan,
                                        RecordingHead head);
  /// Returns null if nothing is recorded.
  Journal* journal() noexcept { return box_ ? &box_->journal() : nullptr; }
  /// From this call on, the recorder accepts requests and reports recordings over LCM. `bridge`
  /// must live until finish() or finish_running() has returned.
  void attach(Bridge& bridge);

  void on_fault(const Notice& notice);
  /// Begins a recording, if there is a black box.
  void record(const std::string& why, Time now);
  /// Begins and ends the recordings that are due. Call this often.
  void serve(Time now);
  /// Call this after the bus thread has ended. Waits for at most `limit`. Returns false if a
  /// recording is still being written; the destructor would wait for it.
  bool finish(const std::string& reason, Time limit);
  /// Call this if the daemon ends while the bus thread still runs. Writes what has been recorded so
  /// far, within `limit`.
  void finish_running(const std::string& reason, Time limit);

 private:
  /// Returns why the request can't be served.
  std::optional<std::string> on_request(const request_t& request);
  void on_written(const std::string& text, const std::string& file);
  void answer_all(bool good, const std::string& text);

  Say say_;
  std::unique_ptr<BlackBox> box_;
  Bridge* bridge_ = nullptr;
  std::deque<request_t> waiting_;  // requests that wait for the next recording
};

}  // namespace takt
