#include "apps/plot/motion/motion_plot.hpp"

#include <algorithm>
#include <chrono>
#include <fmt/format.h>
#include <fstream>
#include <utility>

#include "apps/axis/group/find_axes.hpp"
#include "master/lcm/messages.hpp"
#include "master/lcm/printable_text.hpp"

namespace takt {
namespace {

/// Passes on all messages, and keeps the motions that arrive.
class ListeningTransport final : public Transport {
 public:
  ListeningTransport(std::unique_ptr<Transport> lcm, MotionTrace& trace)
      : lcm_{std::move(lcm)}, trace_{trace} {}

  bool publish(const std::string& channel, std::span<const std::byte> data) override {
    return lcm_->publish(channel, data);
  }
  bool wanted(std::string_view channel) const override { return lcm_->wanted(channel); }
  void subscribe(const std::string& pattern) override { lcm_->subscribe(pattern); }
  void serve(const MessageHandler& handler) override {
    lcm_->serve([&](std::string_view channel, std::span<const std::byte> data) {
      if (channel.ends_with("_MOTION")) {
        if (const auto message = decode<motion_t>(data)) trace_.take(*message);
      }
      handler(channel, data);
    });
  }
  bool drained() const override { return lcm_->drained(); }
  void watch(std::vector<pollfd>& descriptors) const override { lcm_->watch(descriptors); }
  bool good() const override { return lcm_->good(); }
  std::string url() const override { return lcm_->url(); }

 private:
  std::unique_ptr<Transport> lcm_;
  MotionTrace& trace_;
};

std::vector<TracedAxis> traced_axes(const AxisGroup& group, const std::vector<std::string>& names) {
  std::vector<TracedAxis> traced;
  const AxisControl& axes = group.axes();
  for (const std::string& name : names) {
    for (AxisControl::Index i = 0; i < axes.size(); ++i) {
      if (axes.name(i) != name) continue;
      const AxisSignals& signals = axes.signals(i);
      const signal_t& controlword = group.input().signals()[*signals.controlword];
      const auto place = signals.position.value_or(*signals.controlword);
      traced.push_back({.node_id = controlword.node_id,
                        .axis = number_of_axis(controlword.index),
                        .name = printable_text(name),
                        .has_velocity = signals.velocity.has_value(),
                        .unit = printable_text(group.input().signals()[place].unit)});
    }
  }
  return traced;
}

}  // namespace

MotionPlot::MotionPlot(std::string file, std::string title)
    : file_{std::move(file)}, title_{std::move(title)}, trace_{std::make_unique<MotionTrace>()} {}

std::expected<void, std::string> MotionPlot::create() const {
  if (file_.empty() || std::ofstream{file_}.good()) return {};
  return std::unexpected{"--plot: can't write " + file_};
}

std::unique_ptr<Transport> MotionPlot::listen(std::unique_ptr<Transport> lcm) {
  if (file_.empty()) return lcm;
  return std::make_unique<ListeningTransport>(std::move(lcm), *trace_);
}

std::expected<void, std::string> MotionPlot::write(AxisGroup& group,
                                                   const std::vector<std::string>& names) const {
  if (file_.empty()) return {};
  const std::vector<TracedAxis> axes = traced_axes(group, names);
  const double period = std::chrono::duration<double>(group.period()).count();
  const Plot plot = trace_->plot(title_, axes, period);
  if (axes.empty() || plot.panels.empty()) {
    return std::unexpected{"--plot: taktd has reported no motion of these axes, so " + file_ +
                           " is empty"};
  }
  std::ofstream file{file_};
  file << plot_svg(plot);
  file.close();
  if (file.good()) return {};
  return std::unexpected{"--plot: can't write " + file_};
}

Done run_with_plot(AxesProgram program,
                   const std::function<std::expected<Axes, Obstacle>(const AxesProgram&)>& open,
                   const std::function<Done(Axes&)>& work) {
  MotionPlot plot{program.plot, program.name};
  if (const auto created = plot.create(); !created) {
    return std::unexpected{Obstacle{.kind = Obstacle::Kind::wrong_use, .text = created.error()}};
  }
  program.through = [&plot](std::unique_ptr<Transport> lcm) { return plot.listen(std::move(lcm)); };
  auto axes = open(program);
  if (!axes) return std::unexpected{axes.error()};
  const Done done = work(*axes);
  std::vector<std::string> names;
  for (Eigen::Index i = 0; i < axes->size(); ++i) names.push_back(axes->name(i));
  const auto written = plot.write(axes->group(), names);
  if (written || !done) {
    if (!written) fmt::print(stderr, "{}: {}\n", program.name, printable_text(written.error()));
    return done;
  }
  return std::unexpected{Obstacle{.kind = Obstacle::Kind::blocked, .text = written.error()}};
}

}  // namespace takt
