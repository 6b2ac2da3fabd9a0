// A program over LCM: prints the first complete image of a bus, with units, and ends.
#include <chrono>
#include <cstdio>
#include <poll.h>
#include <takt/image_input.hpp>
#include <takt/lcm.hpp>

int main() {
  auto lcm = takt::open_lcm("");  // LCM_DEFAULT_URL, else LCM's default
  if (!lcm) return std::puts(lcm.error().c_str()), 3;
  (*lcm)->subscribe("DEMO_LAYOUT");
  (*lcm)->subscribe("DEMO_IMAGE");
  takt::ImageInput input;
  while (!input.has_image()) {
    std::vector<pollfd> descriptors;
    (*lcm)->watch(descriptors);
    ::poll(descriptors.data(), descriptors.size(), 100);
    input.set_time(std::chrono::steady_clock::now().time_since_epoch().count());
    (*lcm)->serve([&](std::string_view channel, std::span<const std::byte> data) {
      const auto size = static_cast<int>(data.size());
      takt::layout_t layout;
      takt::image_t image;
      if (channel == "DEMO_LAYOUT" && layout.decode(data.data(), 0, size) >= 0) input.take(layout);
      if (channel == "DEMO_IMAGE" && image.decode(data.data(), 0, size) >= 0) input.take(image);
    });
  }
  for (std::size_t i = 0; i < input.signals().size(); ++i) {
    const takt::signal_t& signal = input.signals()[i];
    const double value = static_cast<double>(input.values()[i]) * signal.scale + signal.offset;
    std::printf("%s %s %g %s\n", signal.node.c_str(), signal.name.c_str(), value,
                signal.unit.c_str());
  }
}
