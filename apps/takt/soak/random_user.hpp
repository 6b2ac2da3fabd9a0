#pragma once
#include <cstdint>
#include <map>

#include "apps/takt/simulate/sine_motion.hpp"
#include "apps/takt/soak/evidence/verdict.hpp"
#include "apps/takt/soak/judge/output_judge.hpp"
#include "master/rt/exchange/exchange.hpp"
#include "master/sim/random.hpp"

namespace takt::soak {

/// Acts as the applications of a run: it moves axes, changes outputs, pauses without notice, and
/// sends requests of every kind at random times.
class RandomUser {
 public:
  RandomUser(const BusPlan& plan, Exchange& exchange, OutputJudge& judge, Verdict& verdict,
             sim::Random random);

  /// Answers an image as an application does, with commands.
  void on_image(const ImageView& image, Time now);
  /// Sends a random request, or none. To be called before each cycle.
  void ask(Time now);
  /// Takes the replies. Reports a second reply to a request, and a request that waits too long, as
  /// violations.
  void take_replies(Time now);
  /// Requests a reset of all nodes.
  void reset_all(Time now);

  std::uint64_t asked() const noexcept { return asked_; }
  std::size_t unanswered() const noexcept { return open_.size(); }
  std::size_t most_moving() const noexcept { return motion_.most_moving(); }

 private:
  static constexpr Time reply_limit = std::chrono::seconds{120};  ///< limit for one reply

  void command(SignalIndex signal, std::int64_t value, Time now);
  std::int64_t any_value(SignalIndex signal, std::uint64_t cycle) const;
  Request request();
  void choose_object(Request& request);
  void submit(Request request, Time now);

  const BusPlan& plan_;
  Exchange& exchange_;
  OutputJudge& judge_;
  Verdict& verdict_;
  sim::Random random_;
  SineMotion motion_;
  std::uint32_t silent_ = 0;  ///< number of images that the application still ignores
  std::uint32_t time_to_live_ = 5;
  std::uint64_t asked_ = 0;
  std::map<std::uint64_t, Time> open_;  ///< send times of the requests without a reply, by id
};

}  // namespace takt::soak
