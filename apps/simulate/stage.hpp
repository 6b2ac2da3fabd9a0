#pragma once
#include <algorithm>
#include <vector>

#include "eds_parser/table/time.hpp"

namespace takt {

/// A thread or a program beside the bus thread, in virtual time.
class Actor {
 public:
  virtual ~Actor() = default;
  /// When it does something next; `never`: not by itself.
  virtual Time next() const noexcept = 0;
  /// Does what is due at `now`; afterwards next() is later, or it is due again at once.
  virtual void act(Time now) = 0;
};

/// All actors of a run. Actors outlive the stage.
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
