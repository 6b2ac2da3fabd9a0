#pragma once
#include <algorithm>
#include <vector>

#include "eds_parser/values/time.hpp"

namespace takt {

/// A thread or a program that runs beside the bus thread in virtual time.
class Actor {
 public:
  virtual ~Actor() = default;
  /// Returns the time of the actor's next action; `never` if it only reacts to others.
  virtual Time next() const noexcept = 0;
  /// Performs the action that is due at `now`. Afterwards, next() returns a later time, or `now` if
  /// another action is due.
  virtual void act(Time now) = 0;
};

/// All actors of a run. The actors must outlive the stage.
class Stage {
 public:
  void add(Actor& actor) { actors_.push_back(&actor); }
  Time next() const noexcept {
    Time first = never;
    for (const Actor* actor : actors_) first = std::min(first, actor->next());
    return first;
  }
  void act(Time now) {
    for (std::size_t i = 0; i < actors_.size(); ++i) {
      if (actors_[i]->next() <= now) actors_[i]->act(now);
    }
  }

 private:
  std::vector<Actor*> actors_;
};

}  // namespace takt
