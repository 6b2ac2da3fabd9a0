#include "eds_parser/print/plan/step_frames.hpp"

#include <cstddef>
#include <fmt/format.h>
#include <optional>
#include <set>
#include <utility>

#include "eds_parser/values/ids.hpp"
#include "eds_parser/values/little_endian.hpp"

namespace takt {
namespace {

/// Values of at least this size, in bytes, use block transfer if the node allows it.
constexpr std::size_t block_from = 128;

std::string candump_id(CobId id) {
  return fmt::format("{:0{}X}", id.id(), id.is_extended() ? 8 : 3);
}

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
      default:
        return {};
    }
  }

 private:
  std::string nmt(NmtCommand command) const {
    return fmt::format("000#{:02X}{:02X}", static_cast<unsigned>(command), node_.id.value());
  }

  std::string begin(unsigned specifier, ObjectKey object) const {
    return fmt::format("{}{:02X}{:02X}{:02X}{:02X}", request_, specifier, object.index & 0xFF,
                       object.index >> 8, object.sub);
  }

  /// Returns the request that initiates an upload. CiA 301, 7.2.4.3.5.
  std::string upload(ObjectKey object) const { return begin(0x40, object) + "00000000"; }

  /// Returns the request that initiates a download: expedited up to 4 bytes, else with its size,
  /// segmented or by block. CiA 301, 7.2.4.3.3 and 7.2.4.3.9.
  std::string download(const BootStep& step) const {
    const std::size_t size = step.value.size();
    const bool expedited = size >= 1 && size <= 4;
    const bool block = size >= block_from && node_.sdo.block != SdoBlockUse::off;
    const unsigned plain = expedited ? 0x23U | static_cast<unsigned>((4 - size) << 2U) : 0x21U;
    std::string out = begin(block ? 0xC6U : plain, step.object);
    const std::uint64_t data = expedited ? from_little_endian(step.value) : size;
    for (unsigned i = 0; i < 4; ++i) out += fmt::format("{:02X}", data >> (8 * i) & 0xFF);
    return out;
  }

  /// Leaves the last byte open, because it holds bit 30 of the COB-ID, which the device decides.
  std::string with_bit_30_of_device(const BootStep& step) const {
    const std::string out = download(step);
    return out.substr(0, out.size() - 2) + "..";
  }

  /// Notes that the master has just read or written this object, if the object is a COB-ID that
  /// the boot switches off or on.
  void remember(ObjectKey object) {
    if (switched_.contains(object)) cob_id_ = object;
  }

  /// Returns the frames of a write whose value depends on the value that was read last. An earlier
  /// step may have read this value.
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
