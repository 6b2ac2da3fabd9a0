#include "master/explain/boot_remedy_abort.hpp"

#include <algorithm>

#include "master/explain/boot_remedy_keys.hpp"
#include "master/explain/report_text.hpp"
#include "master/wire/bytes.hpp"
#include "master/wire/sdo_abort.hpp"

namespace takt {
namespace {

bool is_mapping_entry(ObjectKey object) noexcept {
  return (object.index >= 0x1600 && object.index <= 0x17FF) ||
         (object.index >= 0x1A00 && object.index <= 0x1BFF);
}

/// "TPDO2" for a communication or mapping object, "the PDO" for other objects.
std::string pdo_name(ObjectKey object) {
  const unsigned area = object.index & 0xFE00U;
  const std::string number = std::to_string((object.index & 0x1FFU) + 1);
  if (area == 0x1800 || area == 0x1A00) return "TPDO" + number;
  if (area == 0x1400 || area == 0x1600) return "RPDO" + number;
  return "the PDO";
}

/// The object that a mapping entry maps, for example "6077:00"; for other objects, the written
/// object itself.
std::string mapped_object(const BootStep& step) {
  if (!is_mapping_entry(step.object) || step.object.sub == 0 || step.value.size() != 4) {
    return to_string(step.object);
  }
  const auto entry = load_le<std::uint32_t>(std::span{step.value});
  return to_string(ObjectKey{static_cast<std::uint16_t>(entry >> 16),
                             static_cast<std::uint8_t>(entry >> 8 & 0xFF)});
}

std::string against_refused_mapping(const BootStep& step, const BootFailure& failure) {
  const std::string pdo = pdo_name(step.object);
  const std::string object = mapped_object(step);
  switch (failure.abort_code) {
    case abort_code::not_mappable:
    case abort_code::write_only:
      return "the device does not let " + object + " be mapped into " + pdo +
             ", although the EDS may allow it: take " + object + " out of the mapping of " + pdo +
             " in the network file, or map a related object";
    case abort_code::mapping_too_long:
      return "the device can't hold so many bytes or entries in " + pdo +
             ": map fewer or shorter objects, or spread them over two PDOs";
    case abort_code::no_object:
    case abort_code::no_sub_index:
      return step.object.sub == 0 || object == to_string(step.object)
                 ? "the device has no " + to_string(step.object) +
                       ": it has fewer PDOs or entries than its EDS says; use another PDO number"
                 : "the device has no object " + object +
                       ": its firmware is older than the EDS; take the object out of the mapping "
                       "of " +
                       pdo;
    case abort_code::read_only:
      return "the mapping of " + pdo +
             " is fixed in this device: remove its `mapping` from the network file, so that the "
             "device's own mapping is used";
    default:
      return "the device refuses to change " + pdo +
             " now: the device may need a reset first (`reset: communication`), or the mapping is "
             "fixed; then remove `mapping` of this PDO from the network file";
  }
}

std::string against_length(const NodePlan& node, const BootStep& step, const BootFailure& failure) {
  const std::string object = to_string(failure.object);
  const bool is_text = step.eds_note.find("_STRING, ") != std::string::npos ||
                       step.eds_note.find(", DOMAIN, ") != std::string::npos;
  if (!is_text || !failure.downloading) {
    return "the device holds " + object + " in another data type than " + node.description_file +
           " says: use the EDS of this firmware, or correct `DataType` in a copy of it";
  }
  const std::string bytes = std::to_string(step.value.size()) + " bytes";
  if (failure.abort_code == abort_code::length_too_high) {
    return object + " of the device has no room for " + bytes + ": make the value shorter";
  }
  return object + " of the device expects another length than " + bytes +
         ": look up the length in the manual, and pad the value to this length";
}

std::string against_rare_abort(const BootFailure& failure) {
  const std::string object = to_string(failure.object);
  switch (failure.abort_code) {
    case abort_code::toggle_not_alternated:
    case abort_code::command_unknown:
      return "the device complains about the SDO protocol: a second SDO client may be using the "
             "SDO server at the same time (stop other masters and tools)";
    case abort_code::out_of_memory:
      return "the device has no memory for a value of this length in " + object +
             ": make the value shorter";
    case abort_code::access_unsupported:
      return "the device does not let " + object +
             " be accessed in this way or at this time: look up the object in the manual, or take "
             "it out of the network file";
    case abort_code::incompatible_device:
      return object +
             " conflicts with other settings of the device: first set the objects on which it "
             "depends (the master writes the entries of `sdo` in their order)";
    case 0x0609'0036:  // the maximum is below the minimum
      return "the limits of the device for " + object +
             " contradict each other: write the limit objects first, or restore the defaults "
             "(`restore_configuration: 1`)";
    case abort_code::resource_unavailable:
      return "the SDO server of the device is busy: does another master or tool use this server?";
    case abort_code::general_error:
      return "the device gives no reason: look at its EMCY messages (`takt emcy`), at 0x1001 and "
             "at "
             "0x1003";
    case 0x0800'0023:  // no object dictionary
      return "the device has no object dictionary at the moment: reset the device (`reset: node`), "
             "or load its firmware again";
    case abort_code::no_data:
      return object + " holds no value yet: set up the device first with the manufacturer's tool";
    default:
      return {};
  }
}

/// The boot has reset the node before the step that failed.
bool was_reset(const NodePlan& node, const BootFailure& failure) {
  const auto& steps = node.boot_plan.steps;
  const auto before = std::min<std::size_t>(failure.step, steps.size());
  return std::any_of(steps.begin(), steps.begin() + static_cast<std::ptrdiff_t>(before),
                     [](const BootStep& step) {
                       return step.action == BootAction::nmt && is_reset(step.command);
                     });
}

/// For a write that was refused twice, each time after the command PRE-OPERATIONAL. Only a
/// heartbeat shows the NMT state of the device for sure.
std::string against_self_start(const BootFailure& failure) {
  const bool certain = failure.node_state == NmtState::operational;
  return "the device refuses " + to_string(failure.object) +
         " because of its state, although it was sent to PRE-OPERATIONAL (NMT 0x80) twice: it " +
         (certain ? "leaves" : "probably leaves") +
         " PRE-OPERATIONAL by itself. Switch its automatic start off (set bit 2 of its 0x1F80, or "
         "use the tool of its maker), or stop whoever starts it";
}

/// For an object that the device refuses in its present state.
std::string against_state(const NodePlan& node, const BootFailure& failure) {
  return to_string(failure.object) + " can't be " + (failure.downloading ? "written" : "read") +
         " in the present state of the device: disable the drive" +
         (was_reset(node, failure) ? " or leave local control"
                                   : ", leave local control, or let the boot reset it (`reset: "
                                     "communication`, or `reset: node`)");
}

std::string against_refusal(const NodePlan& node, const BootStep& step,
                            const BootFailure& failure) {
  const std::string object = to_string(failure.object);
  if (failure.downloading && is_mapping_entry(step.object)) {
    return against_refused_mapping(step, failure);
  }
  const bool of_state = failure.abort_code == abort_code::device_state ||
                        failure.abort_code == abort_code::local_control ||
                        failure.abort_code == abort_code::hardware_error;
  std::string text = of_state ? std::string{} : against_refused_setting(node, failure);
  if (text.empty()) text = against_rare_abort(failure);
  if (!text.empty()) return text;
  switch (failure.abort_code) {
    case abort_code::no_object:
    case abort_code::no_sub_index:
      return "the device has no " + object + ", although " + node.description_file +
             " may list it: compare the firmware with the EDS, or remove the entry from the "
             "network file";
    case abort_code::read_only:
      return object + " can't be written: remove it from the network file";
    case abort_code::write_only:
      return failure.downloading ? "the device says that " + object +
                                       " is write-only, although the master did write it: look up "
                                       "the object in the manual"
                                 : object +
                                       " can't be read: if the EDS gives it the access `wo`, the "
                                       "master writes it without a comparison";
    case abort_code::length_mismatch:
    case abort_code::length_too_high:
    case abort_code::length_too_low:
      return against_length(node, step, failure);
    case abort_code::invalid_value:
    case abort_code::value_too_high:
    case abort_code::value_too_low:
    case abort_code::incompatible_parameters:
      return "the device does not accept this value for " + object +
             ": look up its range in the manual and correct the network file";
    case abort_code::cannot_store:
    case abort_code::local_control:
    case abort_code::device_state:
      return against_state(node, failure);
    case abort_code::hardware_error:
      return "the device reports a hardware error: switch the device off and on; if the error "
             "remains, its flash memory may be worn out";
    default:
      return "look up " + object + " and abort code " + abort_digits(failure.abort_code) +
             " in the manual of the device";
  }
}

}  // namespace

std::string against_abort(const NodePlan& node, const BootStep& step, const BootFailure& failure) {
  const std::string text = against_refusal(node, step, failure);
  // In PRE-OPERATIONAL, the NMT state is not the cause.
  if (!failure.preop_again || failure.node_state == NmtState::preoperational) return text;
  const std::string self_start = against_self_start(failure);
  return failure.node_state == NmtState::operational ? self_start : self_start + ". Else: " + text;
}

}  // namespace takt
