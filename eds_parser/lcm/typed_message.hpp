#pragma once
#include <cstdint>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "eds_parser/table/bus_plan.hpp"

namespace takt {

/// Primitive types of LCM. LCM has no unsigned types, so an unsigned value gets the next wider
/// type.
enum class LcmPrimitive : std::uint8_t {
  boolean,
  int8,
  int16,
  int32,
  int64,
  float32,
  float64,
  string,
};

std::string_view name(LcmPrimitive type) noexcept;

struct TypedField {
  std::string name;
  LcmPrimitive type = LcmPrimitive::int64;
  std::string comment{};
  std::optional<SignalIndex> signal{};  ///< empty for a field that every such message has
};

/// The LCM type of one node's inputs, or of the set-points for its outputs.
struct TypedMessage {
  std::string package;  ///< "lift"
  std::string name;     ///< "shoulder_state_t"
  std::string channel;  ///< "LIFT_SHOULDER_STATE", different for each message
  std::uint8_t node_index = 0;
  bool command = false;
  std::vector<TypedField> fields{};

  /// Returns the hash that lcm-gen's code sends in front of each message. It covers names, types
  /// and order of the fields.
  std::uint64_t fingerprint() const noexcept;
};

/// Returns the message types of all nodes of a bus: a state for each node with inputs, a command
/// for each node with outputs. All names are valid in C, C++, Java and Python. Scaled values are
/// doubles in SI units.
std::vector<TypedMessage> typed_messages(const BusPlan& plan);

}  // namespace takt
