#pragma once
#include <cstdint>
#include <map>

#include "apps/simulate/sine_motion.hpp"
#include "apps/soak/output_judge.hpp"
#include "apps/soak/verdict.hpp"
#include "master/rt/exchange.hpp"
#include "master/sim/random.hpp"

namespace takt {

/// The applications of a run: axes that move, outputs that change, pauses without a word, and
/// requests of every kind at random times.
class RestlessUser {
 public:
  RestlessUser(const BusPlan& plan, Exchange& exchange, OutputJudge& judge, Verdict& verdict,
               sim::Random random);

  /// What an application does when an image has come.
  void on_image(const ImageView& image, Time now);
  /// Perhaps asks for something; takes the answers.
  void ask(Time now);
  void take_replies(Time now);
  /// From now on only this is asked for: every node is to be reset.
  void reset_all(Time now);

  std::uint64_t asked() const noexcept { return asked_; }
  std::size_t unanswered() const noexcept { return open_.size(); }
  std::size_t most_moving() const noexcept { return motion_.most_moving(); }

 private:
  static constexpr Time patience = std::chrono::seconds{120};  ///< for one answer

  void command(SignalIndex signal, std::int64_t value, Time now);
  Request request();
  void choose_object(Request& request);
  void submit(Request request, Time now);

  const BusPlan& plan_;
  Exchange& exchange_;
  OutputJudge& judge_;
  Verdict& verdict_;
  sim::Random random_;
  SineMotion motion_;
  std::uint32_t silent_ = 0;  ///< images that the application still ignores
  std::uint32_t time_to_live_ = 5;
  std::uint64_t asked_ = 0;
  std::map<std::uint64_t, Time> open_;  ///< requests without an answer
};

}  // namespace takt
