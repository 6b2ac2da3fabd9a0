// The first motion of the README: two axes move to a point and back. taktd runs the motions.
#include <cstdio>
#include <takt/motion.hpp>

int main() {
  auto axes = takt::Axes::open({.bus = "demo", .names = {"shoulder", "elbow"}});
  if (!axes) return std::puts(axes.error().text.c_str()), 3;
  const takt::MotionBounds bounds{.velocity = Eigen::Vector2d{3.0, 3.0},         // rad/s
                                  .acceleration = Eigen::Vector2d{20.0, 20.0}};  // rad/s^2
  takt::Done done = axes->enable();
  if (done) done = axes->move(Eigen::Vector2d{1.5, 0.5}, bounds);
  if (done) done = axes->move_by(Eigen::Vector2d{-1.5, -0.5}, bounds);
  std::puts(done ? "done" : done.error().text.c_str());
  return done ? 0 : 1;  // the axes are disabled here
}
