#include <array>
#include <cstddef>
#include <cstdint>
#include <memory>
#include <set>

#include "eds_parser/network_file/load_network.hpp"
#include "master/attach.hpp"
#include "master/explain/boot_report.hpp"
#include "master/master_run.hpp"
#include "master/sim/bus/sim_port.hpp"
#include "master/sim/bus/world.hpp"
#include "test/fuzz/input.hpp"

namespace {

using takt::CobId;
using takt::Frame;
using takt::Time;
using takt::fuzz::demand;
using takt::fuzz::Input;

const takt::LoadedNetwork& network() {
  static const auto loaded = takt::load_network(TAKT_SOURCE_DIR "/share/demo/two_axes.yaml");
  return loaded;
}

/// The whole master on a simulated bus in virtual time, and a sender whose frames come from the
/// input. It sends in addition to the simulated devices, or in place of devices that are off.
class Bus {
 public:
  explicit Bus(std::uint8_t devices_off)
      : world_{network().devices, {.bitrate = network().plan.bitrate}},
        port_{world_, {.sync = network().plan.cycle.sync_cob_id}},
        stranger_{world_.attach()},
        master_{network().plan} {
    const auto& nodes = network().plan.nodes;
    for (std::size_t i = 0; i < nodes.size(); ++i) {
      if ((devices_off >> i & 1) != 0) world_.power(nodes[i].id, false);
    }
    master_.attach(port_);
    master_.begin();
  }

  void act(Input& input) {
    const std::uint8_t what = input.byte();
    run(what & 0x1F);
    switch (what >> 5) {
      case 0:
        return ask(input);
      case 1:
        return command(input);
      case 2:
        return send(sdo_answer(input));
      default:
        return send(frame(input));
    }
  }
  void run(unsigned cycles) {
    for (unsigned i = 0; i < cycles; ++i) cycle();
  }
  /// The ordered stop must end within its time limit, whatever happens on the bus.
  void stop() {
    master_.request_stop();
    const Time until = world_.now() + network().plan.stop_timeout + std::chrono::seconds{2};
    while (!master_.finished()) {
      demand(world_.now() < until);
      cycle();
    }
    demand(answered_.size() == asked_);
  }

 private:
  void cycle() {
    const Time before = world_.now();
    master_.cycle();
    demand(master_.finished() || world_.now() > before);
    takt::ImageView image;
    while (master_.take(image)) {
      demand(image.cycle > newest_);
      newest_ = image.cycle;
    }
    for (takt::Event event; master_.take(event);) {
      demand(!takt::describe(network().plan, event).empty());
    }
    for (takt::Reply reply; master_.take(reply);) {
      if (reply.id == 0) continue;  // a device has written 0x1F82 of the master
      demand(answered_.insert(reply.id).second);
      demand(reply.size <= takt::request_bytes);
    }
  }
  std::uint8_t node(Input& input) const {
    const auto& nodes = network().plan.nodes;
    const std::uint8_t which = input.byte();
    return which % 8 == 7 ? which & 0x7F : nodes[which % nodes.size()].id.value();
  }
  void fill(Frame& frame, Input& input, std::uint8_t length) const {
    frame.length = length;
    const auto bytes = input.bytes(length);
    std::copy(bytes.begin(), bytes.end(), frame.data.begin());
  }
  /// Makes an SDO answer of a node from any eight bytes.
  Frame sdo_answer(Input& input) const {
    Frame answer{.id = CobId::base(0x580U + node(input))};
    fill(answer, input, 8);
    return answer;
  }
  Frame frame(Input& input) const {
    constexpr std::array<std::uint16_t, 6> bases{0x000, 0x080, 0x180, 0x280, 0x600, 0x700};
    const std::uint8_t how = input.byte();
    const std::size_t base = how & 0x07;
    Frame frame{.id = CobId::base(0)};
    if (base < bases.size()) {
      frame.id = CobId::base(bases[base] == 0 ? 0U : bases[base] + node(input));
    } else if (base == 6) {
      frame.id = CobId::base(static_cast<std::uint32_t>(input.number(2)) & 0x7FF);
    } else {
      frame.id = CobId::extended(static_cast<std::uint32_t>(input.number(4)) & 0x1FFF'FFFF);
    }
    frame.rtr = (how & 0x08) != 0;
    fill(frame, input, static_cast<std::uint8_t>((how >> 4) % 9));
    return frame;
  }
  void send(const Frame& frame) {
    std::array<takt::StampedFrame, 64> heard;
    while (stranger_.receive(heard) == heard.size()) {
    }
    stranger_.send({&frame, 1}, world_.now());
  }

  /// Submits a request of an application.
  void ask(Input& input) {
    takt::Request request;
    request.id = asked_ + 1;
    request.kind = static_cast<takt::RequestKind>(input.byte() % 6);
    request.node = node(input);
    request.object = {static_cast<std::uint16_t>(input.number(2)), input.byte()};
    constexpr std::array commands{
        takt::NmtCommand::start, takt::NmtCommand::stop, takt::NmtCommand::enter_preoperational,
        takt::NmtCommand::reset_node, takt::NmtCommand::reset_communication};
    request.command = commands[request.object.sub % commands.size()];
    request.timeout = std::chrono::milliseconds{20};
    const auto data = input.bytes(input.byte() % 64);
    std::ranges::copy(std::as_bytes(data), request.data.begin());
    request.size = static_cast<std::uint16_t>(data.size());
    asked_ += master_.submit(request);
  }
  /// Sets set-points of an application.
  void command(Input& input) {
    const auto& layout = network().plan.layout;
    const std::size_t signal = layout.inputs + input.byte() % layout.outputs();
    const auto value = static_cast<std::int64_t>(input.number(4));
    master_.set(static_cast<takt::SignalIndex>(signal), value, input.byte());
    master_.publish_outputs(world_.now());
  }

  takt::sim::World world_;
  takt::sim::SimPort port_;
  takt::sim::RemotePort& stranger_;
  takt::MasterRun master_;
  std::uint64_t newest_ = 0;
  std::uint64_t asked_ = 0;
  std::set<std::uint64_t> answered_;
};

}  // namespace

/// Sends any frames and requests to the whole master: SDO, PDO, NMT, EMCY, heartbeats, LSS.
extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  Input input{data, size};
  const std::uint8_t options = input.byte();
  const auto bus = std::make_unique<Bus>(options & 0x07);
  bus->run((options >> 4) * 40U);
  for (int acts = 0; acts < 100 && !input.empty(); ++acts) bus->act(input);
  bus->run(20);
  if ((options & 0x08) != 0) bus->stop();
  return 0;
}
