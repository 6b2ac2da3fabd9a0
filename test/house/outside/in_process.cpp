// A master in the program: boots the bus of one_axis.yaml, enables the axis, and moves it by 1 rad.
#include <chrono>
#include <cstdio>
#include <takt/drive402.hpp>
#include <takt/master.hpp>

int main(int argc, char** argv) {
  using namespace std::chrono_literals;
  if (argc != 3) return 2;  // NETWORK.yaml BUS, for example one_axis.yaml virtual
  auto master = takt::Master::start(takt::NetworkFile::load(argv[1]), {.bus = argv[2]});
  if (!master) return std::puts(master.error().c_str()), 2;

  const takt::NetworkFile& network = master->network();
  const auto statusword = network.find_input("axis", 0x6041);
  const auto position = network.find_input("axis", 0x6064);
  const auto controlword = network.find_output("axis", 0x6040);
  const auto mode = network.find_output("axis", 0x6060);
  const auto target_position = network.find_output("axis", 0x607A);
  if (!statusword || !position || !controlword || !mode || !target_position) return 2;

  takt::DriveSequence drive;
  drive.set_goal(takt::DriveGoal::enabled);
  double start = 0.0;  // rad
  double target = 0.0;
  while (target - start < 1.0 && master->wait(1s)) {  // image k
    const auto word = drive.step(static_cast<std::uint16_t>(master->raw(*statusword)));
    if (!drive.enabled()) start = target = master->value(*position);
    if (drive.enabled()) target += 0.002;
    master->set_raw(*controlword, word);
    master->set_raw(*mode, static_cast<int>(takt::DriveMode::cyclic_position));
    master->set(*target_position, target);
    master->send();  // acts at SYNC k+1
  }
  while (const auto event = master->take_event()) std::puts(event->text.c_str());
  std::printf("target %.3f rad, position %.3f rad\n", target, master->value(*position));
  return master->stop() ? 0 : 1;  // the axis was seen at standstill, and is disabled
}
