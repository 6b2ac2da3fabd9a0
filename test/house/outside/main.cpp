// An application outside takt's tree: reads an EDS, decodes a statusword, encodes a message.
#include <cstdio>

#include "apps/axis/state402.hpp"
#include "eds_parser/read/eds.hpp"
#include "master/lcm/messages.hpp"

int main(int argc, char** argv) {
  if (argc != 2) return 2;
  const takt::EdsFile eds = takt::read_eds_file(argv[1]);
  if (!eds.readable || eds.dictionary.find(0x6041) == nullptr) return 1;
  takt::command_t command{};
  command.sender = "outside";
  std::vector<std::byte> buffer;
  const auto back = takt::decode<takt::command_t>(takt::encode(command, buffer));
  if (!back || back->sender != "outside") return 1;
  std::printf("%s: %zu objects, statusword 0x0237 means %s\n",
              eds.dictionary.device.product_name.c_str(), eds.dictionary.objects.size(),
              takt::name(*takt::decode_statusword(0x0237)).data());
  return 0;
}
