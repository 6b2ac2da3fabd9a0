// A program with the code of the planner, for instruction_bound.py. Its result is of no interest.
#include "master/motion/trajectory.hpp"

int main(int count, char**) {
  takt::motion::AxisTask task;
  task.to.position = count;
  takt::motion::PlannedAxis planned;
  const auto done = takt::motion::plan_trajectory({&task, 1}, {}, std::span{&planned, 1});
  return done.has_value() ? 0 : 1;
}
