#pragma once
#include <string>

#include "eds_parser/dictionary/object_dictionary.hpp"
#include "eds_parser/specification/device_data.hpp"

namespace takt::init {

/// `tpdo:` and `rpdo:` of a node, as lines of a network file.
struct ProposedPdos {
  std::string text{};
  bool commands_position = false;  ///< an RPDO carries the target position of a CiA 402 axis
};

/// Proposes the PDOs by the profile of the device: for each axis of a CiA 402 drive, the
/// controlword, the target and the mode, and the statusword, the actual value and the displayed
/// mode; for other devices, the PDOs of the device file. `data` is nullptr without device data.
ProposedPdos proposed_pdos(const ObjectDictionary& dictionary, const DeviceData* data);

/// Proposes the PDOs that are switched on in the device file, with the mapping in this file. They
/// are exchanged with each SYNC if the device supports that. A parameter channel is left out.
ProposedPdos pdos_of_file(const ObjectDictionary& dictionary, const DeviceData* data);

}  // namespace takt::init
