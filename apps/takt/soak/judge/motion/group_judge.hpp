#pragma once
#include <cstdint>
#include <optional>
#include <vector>

#include "apps/takt/soak/evidence/verdict.hpp"
#include "apps/takt/soak/judge/motion/motion_orders.hpp"

namespace takt::soak {

/// Checks that the axes of a group begin in one cycle. It watches groups without synchronisation
/// whose axes are at rest. Each axis then accelerates along its own limits, so the position at
/// which it has its velocity shows when it has begun.
class GroupJudge {
 public:
  GroupJudge(const BusPlan& plan, Verdict& verdict) : plan_{plan}, verdict_{verdict} {}

  /// An axis of a group. The axis is at rest before the motion begins.
  struct Member {
    std::size_t axis = 0;
    double from = 0;    ///< position at rest, in counts
    double target = 0;  ///< target in counts
    MotionBounds bounds{};
  };

  /// Watches a group that was commanded now.
  void watch(const std::vector<Member>& members);
  /// Forgets the groups of this axis: another motion moves it, or its drive does not follow.
  void forget(std::size_t axis);
  /// Forgets all groups, because cycles were left out.
  void forget_all() { groups_.clear(); }
  /// Call this when the axis has received this set-point, in counts.
  void sent(std::size_t axis, double value, Time now);
  std::uint64_t judged() const noexcept { return judged_; }  ///< groups whose begin was seen

 private:
  struct Begin {
    Member member{};
    double value = 0;  ///< newest set-point
    /// A set-point at which the velocity was reached, and the time at which it was sent.
    std::optional<double> cruises_at{};
    Time cruises_since{};
    std::optional<Time> begun{};
  };
  struct Group {
    std::vector<Begin> axes;
    bool over = false;
  };

  void look(Begin& axis, Group& group, double value, Time now) const;
  void judge(Group& group, Time now);

  const BusPlan& plan_;
  Verdict& verdict_;
  std::vector<Group> groups_;
  std::uint64_t judged_ = 0;
};

}  // namespace takt::soak
