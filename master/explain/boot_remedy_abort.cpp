#include <algorithm>
#include <fmt/format.h>

#include "eds_parser/values/pdo_number.hpp"
#include "master/explain/boot_remedy.hpp"
#include "master/explain/report_text.hpp"
#include "master/wire/bytes.hpp"
#include "master/wire/sdo_abort.hpp"

namespace takt {
namespace {

/// Returns "TPDO2" for a communication or mapping object, and "the PDO" for other objects.
std::string pdo_name(ObjectKey object) {
  const unsigned area = object.index & 0xFE00U;
  const unsigned number = (object.index & 0x1FFU) + 1;
  if (area == 0x1800 || area == 0x1A00) return fmt::format("TPDO{}", number);
  if (area == 0x1400 || area == 0x1600) return fmt::format("RPDO{}", number);
  return "the PDO";
}

/// Returns the object that a mapping entry maps, for example "6077:00". For other objects, returns
/// the written object itself.
std::string mapped_object(const BootStep& step) {
  if (!is_pdo_mapping(step.object.index) || step.object.sub == 0 || step.value.size() != 4) {
    return to_string(step.object);
  }
  const auto entry = load_le<std::uint32_t>(std::span{step.value});
  return to_string(ObjectKey{static_cast<std::uint16_t>(entry >> 16),
                             static_cast<std::uint8_t>(entry >> 8 & 0xFF)});
}

using namespace abort_code;

/// The advice for an abort code: what the user can try. `{object}` stands for the object, `{eds}`
/// for the file that describes the device, `{pdo}` for the PDO, `{code}` for the abort code.
struct Advice {
  std::uint32_t code;
  std::string_view text;
};

constexpr std::string_view not_mapped =
    "the device does not let {object} be mapped into {pdo}, although the EDS may allow it: take "
    "{object} out of the mapping of {pdo} in the network file, or map a related object";
constexpr std::string_view older_firmware =
    "the device has no object {object}: its firmware is older than the EDS; take the object out of "
    "the mapping of {pdo}";
constexpr std::string_view two_clients =
    "the device reports a violation of the SDO protocol: a second SDO client may use the SDO "
    "server at the same time (stop other masters and tools)";
constexpr std::string_view missing =
    "the device has no {object}, although {eds} may list it: compare the firmware with the EDS, or "
    "remove the entry from the network file";
constexpr std::string_view out_of_range =
    "the device does not accept this value for {object}: look up its range in the manual and "
    "correct the network file";

/// The advice for a write to a mapping entry. The code 0 stands for all other codes.
constexpr Advice mapping_advice[] = {
    {not_mappable, not_mapped},
    {write_only, not_mapped},
    {mapping_too_long,
     "the device can't hold so many bytes or entries in {pdo}: map fewer or shorter objects, or "
     "spread them over two PDOs"},
    {no_object, older_firmware},
    {no_sub_index, older_firmware},
    {read_only,
     "the mapping of {pdo} is fixed in this device: remove its `mapping` from the network file, so "
     "that the device's own mapping is used"},
    {0,
     "the device refuses to change {pdo} now: the device may need a reset first (`reset: "
     "communication`), or the mapping is fixed; then remove `mapping` of this PDO from the network "
     "file"}};

/// The advice for codes that name their cause. It is the same for all objects.
constexpr Advice advice[] = {
    {toggle_not_alternated, two_clients},
    {command_unknown, two_clients},
    {out_of_memory,
     "the device has no memory for a value of this length in {object}: make the value shorter"},
    {access_unsupported,
     "the device does not let {object} be accessed in this way or at this time: look up the object "
     "in the manual, or take it out of the network file"},
    {incompatible_device,
     "{object} conflicts with other settings of the device: first set the objects on which it "
     "depends (the master writes the entries of `sdo` in their order)"},
    {0x0609'0036,  // the maximum is below the minimum
     "the limits of the device for {object} contradict each other: write the limit objects first, "
     "or restore the defaults (`restore_configuration: 1`)"},
    {resource_unavailable,
     "the SDO server of the device is busy: does another master or tool use this server?"},
    {general_error,
     "the device gives no reason: look at its EMCY messages (`takt emcy`), at 0x1001 and at "
     "0x1003"},
    {0x0800'0023,  // no object dictionary
     "the device has no object dictionary at the moment: reset the device (`reset: node`), or load "
     "its firmware again"},
    {no_data, "{object} holds no value yet: set up the device first with the manufacturer's tool"},
    {no_object, missing},
    {no_sub_index, missing},
    {read_only, "{object} can't be written: remove it from the network file"},
    {invalid_value, out_of_range},
    {value_too_high, out_of_range},
    {value_too_low, out_of_range},
    {incompatible_parameters, out_of_range},
    {hardware_error,
     "the device reports a hardware error: switch the device off and on; if the error remains, its "
     "flash memory may be worn out"},
    {0, "look up {object} and abort code {code} in the manual of the device"}};

/// Fills in the placeholders of the advice against the abort code of `failure`.
std::string advice_text(std::span<const Advice> rows, const NodePlan& node,
                        const BootFailure& failure, const std::string& object,
                        const std::string& pdo = {}) {
  const auto of_code = std::ranges::find(rows, failure.abort_code, &Advice::code);
  const Advice& row = of_code == rows.end() ? rows.back() : *of_code;
  return fmt::format(fmt::runtime(row.text), fmt::arg("object", object), fmt::arg("pdo", pdo),
                     fmt::arg("eds", node.description_file),
                     fmt::arg("code", abort_digits(failure.abort_code)));
}

std::string against_refused_mapping(const NodePlan& node, const BootStep& step,
                                    const BootFailure& failure) {
  const std::string object = mapped_object(step);
  const bool missing_entry = failure.abort_code == no_object || failure.abort_code == no_sub_index;
  if (missing_entry && object == to_string(step.object)) {
    return "the device has no " + object +
           ": it has fewer PDOs or entries than its EDS says; use another PDO number";
  }
  return advice_text(mapping_advice, node, failure, object, pdo_name(step.object));
}

std::string against_length(const NodePlan& node, const BootStep& step, const BootFailure& failure) {
  const std::string object = to_string(failure.object);
  const bool is_text = step.eds_note.find("_STRING, ") != std::string::npos ||
                       step.eds_note.find(", DOMAIN, ") != std::string::npos;
  if (!is_text || !failure.downloading) {
    return fmt::format(
        "the device holds {} in another data type than {} says: use the EDS of this firmware, or "
        "correct `DataType` in a copy of it",
        object, node.description_file);
  }
  const std::size_t bytes = step.value.size();
  if (failure.abort_code == length_too_high) {
    return fmt::format("{} of the device has no room for {} bytes: make the value shorter", object,
                       bytes);
  }
  return fmt::format(
      "{} of the device expects another length than {} bytes: look up the length in the manual, "
      "and pad the value to this length",
      object, bytes);
}

/// Returns true if the boot has reset the node before the step that failed.
bool was_reset(const NodePlan& node, const BootFailure& failure) {
  const auto& steps = node.boot_plan.steps;
  const auto before = std::min<std::size_t>(failure.step, steps.size());
  return std::any_of(steps.begin(), steps.begin() + static_cast<std::ptrdiff_t>(before),
                     [](const BootStep& step) {
                       return step.action == BootAction::nmt && is_reset(step.command);
                     });
}

/// Returns the advice for a write that was refused twice, each time after the command
/// PRE-OPERATIONAL. Only a heartbeat shows the NMT state of the device with certainty.
std::string against_self_start(const BootFailure& failure) {
  return fmt::format(
      "the device refuses {} because of its state, although it was sent to PRE-OPERATIONAL (NMT "
      "0x80) twice: it {} PRE-OPERATIONAL by itself. Switch its automatic start off (set bit 2 of "
      "its 0x1F80, or use the tool of its manufacturer), or stop the master or tool that starts it",
      to_string(failure.object),
      failure.node_state == NmtState::operational ? "leaves" : "probably leaves");
}

/// Returns the advice for an object that the device refuses in its present state.
std::string against_state(const NodePlan& node, const BootFailure& failure) {
  return fmt::format("{} can't be {} in the present state of the device: disable the drive{}",
                     to_string(failure.object), failure.downloading ? "written" : "read",
                     was_reset(node, failure) ? " or leave local control"
                                              : ", leave local control, or let the boot reset it "
                                                "(`reset: communication`, or `reset: node`)");
}

std::string against_refusal(const NodePlan& node, const BootStep& step,
                            const BootFailure& failure) {
  const std::string object = to_string(failure.object);
  if (failure.downloading && is_pdo_mapping(step.object.index)) {
    return against_refused_mapping(node, step, failure);
  }
  switch (failure.abort_code) {
    case device_state:
    case local_control:
      return against_state(node, failure);
    case hardware_error:
      return advice_text(advice, node, failure, object);
    default:
      break;
  }
  if (std::string text = against_refused_setting(node, failure); !text.empty()) return text;
  switch (failure.abort_code) {
    case write_only:
      return failure.downloading
                 ? "the device says that " + object +
                       " is write-only, although the master has only written it: look up "
                       "the object in the manual"
                 : object +
                       " can't be read: if the EDS gives it the access `wo`, the "
                       "master writes it without a comparison";
    case length_mismatch:
    case length_too_high:
    case length_too_low:
      return against_length(node, step, failure);
    case cannot_store:
      return against_state(node, failure);
    default:
      return advice_text(advice, node, failure, object);
  }
}

}  // namespace

std::string against_abort(const NodePlan& node, const BootStep& step, const BootFailure& failure) {
  const std::string text = against_refusal(node, step, failure);
  // The NMT state is not the cause if the device is in PRE-OPERATIONAL.
  if (!failure.preop_again || failure.node_state == NmtState::preoperational) return text;
  const std::string self_start = against_self_start(failure);
  return failure.node_state == NmtState::operational ? self_start : self_start + ". Else: " + text;
}

}  // namespace takt
