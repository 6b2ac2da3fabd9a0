#include "eds_parser/print/plan/step_frames.hpp"

#include <cstddef>
#include <optional>
#include <set>
#include <string_view>
#include <utility>

#include "eds_parser/table/ids.hpp"

namespace takt {
namespace {

/// Values of at least this size, in bytes, use block transfer if the node allows it.
constexpr std::size_t block_from = 128;

void add_byte(std::string& out, unsigned value) {
  constexpr std::string_view digits = "0123456789ABCDEF";
  out += digits[(value >> 4) & 0xF];
  out += digits[value & 0xF];
}

std::string candump_id(CobId id) { return hex(id.id(), id.is_extended() ? 8 : 3).substr(2); }

class Frames {
 public:
  explicit Frames(const NodePlan& node)
      : node_{node}, request_{candump_id(node.sdo.channel_of(node.id).request) + "#"} {
    for (const BootStep& step : node.boot_plan.steps) {
      const bool enables = step.action == BootAction::enable_pdo;
      if (enables || step.action == BootAction::disable_pdo) switched_.insert(step.object);
    }
  }

  StepFrames of(const BootStep& step) {
    switch (step.action) {
      case BootAction::nmt:
        return {.first = nmt(step.command)};
      case BootAction::write:
      case BootAction::write_if_changed:
      case BootAction::download_program:
        remember(step.object);
        return {.first = download(step)};
      case BootAction::write_if_differs:
        return {.first = upload(step.object), .write = download(step)};
      case BootAction::disable_pdo:
        return after_reading(step.object, begin(0x23, step.object) + "........");
      case BootAction::enable_pdo:
        return after_reading(step.object, with_bit_30_of_device(step));
      case BootAction::compare:
      case BootAction::verify:
        remember(step.object);
        return {.first = upload(step.object)};
      case BootAction::probe:
      case BootAction::await_value:
      case BootAction::read_serial:
      case BootAction::read_firmware:
      case BootAction::read_limit:
      case BootAction::expect:
        return {.first = upload(step.object)};
      case BootAction::await_bootup:
      case BootAction::await_alive:
      case BootAction::skip_if_same:
      case BootAction::await_heartbeat:
      case BootAction::await_guarding:
      case BootAction::await_operational:
      case BootAction::pause:
        return {};
    }
    return {};
  }

 private:
  std::string nmt(NmtCommand command) const {
    std::string out = "000#";
    add_byte(out, static_cast<unsigned>(command));
    add_byte(out, node_.id.value());
    return out;
  }

  std::string begin(unsigned specifier, ObjectKey object) const {
    std::string out = request_;
    add_byte(out, specifier);
    add_byte(out, object.index);
    add_byte(out, object.index >> 8U);
    add_byte(out, object.sub);
    return out;
  }

  /// The request that initiates an upload. CiA 301, 7.2.4.3.5.
  std::string upload(ObjectKey object) const { return begin(0x40, object) + "00000000"; }

  /// The request that initiates a download: expedited up to 4 bytes, else with its size, segmented
  /// or by block. CiA 301, 7.2.4.3.3 and 7.2.4.3.9.
  std::string download(const BootStep& step) const {
    const std::size_t size = step.value.size();
    const bool expedited = size >= 1 && size <= 4;
    const bool block = size >= block_from && node_.sdo.block != SdoBlockUse::off;
    const unsigned plain = expedited ? 0x23U | static_cast<unsigned>((4 - size) << 2U) : 0x21U;
    std::string out = begin(block ? 0xC6U : plain, step.object);
    for (std::size_t i = 0; i < 4; ++i) {
      const unsigned data = i < size ? std::to_integer<unsigned>(step.value[i]) : 0U;
      add_byte(out, expedited ? data : static_cast<unsigned>(size >> (8 * i)));
    }
    return out;
  }

  /// Leaves the last byte open, because it holds bit 30 of the COB-ID, which the device decides.
  std::string with_bit_30_of_device(const BootStep& step) const {
    const std::string out = download(step);
    return out.substr(0, out.size() - 2) + "..";
  }

  /// Remembers that the master knows this COB-ID from now on.
  void remember(ObjectKey object) {
    if (switched_.contains(object)) cob_id_ = object;
  }

  /// The written value depends on the value that was read last. An earlier step may have read it
  /// already.
  StepFrames after_reading(ObjectKey object, std::string write) {
    if (cob_id_ == object) return {.first = std::move(write)};
    cob_id_ = object;
    return {.first = upload(object), .write = std::move(write)};
  }

  const NodePlan& node_;
  std::string request_;
  std::set<ObjectKey> switched_{};     ///< COB-IDs that the boot switches off or on
  std::optional<ObjectKey> cob_id_{};  ///< COB-ID that was read or written last
};

}  // namespace

std::vector<StepFrames> step_frames(const NodePlan& node) {
  Frames frames{node};
  std::vector<StepFrames> out;
  out.reserve(node.boot_plan.steps.size());
  for (const BootStep& step : node.boot_plan.steps) out.push_back(frames.of(step));
  return out;
}

}  // namespace takt
