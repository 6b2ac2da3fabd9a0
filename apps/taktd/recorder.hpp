#pragma once
#include <deque>
#include <expected>
#include <functional>
#include <memory>
#include <string>
#include <takt/request_t.hpp>

#include "apps/black_box/black_box.hpp"
#include "master/gateway/bridge.hpp"
#include "master/gateway/notice.hpp"

namespace takt {

/// The daemon's black box and those who ask for recordings: faults, SIGUSR1, requests over LCM.
/// Each request is answered once, with the file or with the reason why there is none. Front thread.
class Recorder {
 public:
  using Say = std::function<void(Weight weight, const std::string& sentence)>;

  explicit Recorder(Say say) : say_{std::move(say)} {}

  /// Nothing is recorded before. An error is a sentence. `plan` outlives this.
  std::expected<void, std::string> open(const BlackBoxOptions& options, const BusPlan& plan,
                                        RecordingHead head);
  /// Null: nothing is recorded.
  Journal* journal() noexcept { return box_ ? &box_->journal() : nullptr; }
  /// From here on requests are heard and recordings are told to LCM. Outlives this.
  void attach(Bridge& bridge, std::int64_t session);

  void on_fault(const Notice& notice);
  /// Often: begins and ends what is due.
  void serve(Time now);
  /// The bus thread has ended. Waits for at most `limit`; false: a recording is still being
  /// written, and the destructor would wait for it.
  bool finish(const std::string& reason, Time limit);
  /// The bus thread runs on and nobody waits for it any longer: what it has recorded so far is
  /// written, within `limit`.
  void finish_running(const std::string& reason, Time limit);

 private:
  void on_request(const request_t& request);
  void on_written(const std::string& text, const std::string& file);
  void answer_all(bool good, const std::string& text);

  Say say_;
  std::unique_ptr<BlackBox> box_;
  Bridge* bridge_ = nullptr;
  std::int64_t session_ = 0;
  std::deque<request_t> waiting_;  // for the next recording
};

}  // namespace takt
