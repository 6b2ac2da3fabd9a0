#pragma once
#include <cstdint>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "eds_parser/table/bus_plan.hpp"

namespace takt {

/// Primitive types of LCM. It has no unsigned ones: those get the next wider.
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
  std::optional<SignalIndex> signal{};  ///< none: a field that every such message has
  std::string comment{};
};

/// The LCM type of one node's inputs, or of the set-points for its outputs.
struct TypedMessage {
  std::string package;  ///< "lift"
  std::string name;     ///< "shoulder_state_t"
  std::string channel;  ///< "LIFT_SHOULDER_STATE"; another one each
  std::uint8_t node_index = 0;
  bool command = false;
  std::vector<TypedField> fields{};

  /// What lcm-gen's code sends in front of each message: of names, types and order of the fields.
  std::uint64_t fingerprint() const noexcept;
};

/// The types of all nodes of a bus: a state each that has inputs, a command each that has outputs.
/// Names are usable in C, C++, Java and Python alike; scaled values are SI in doubles.
std::vector<TypedMessage> typed_messages(const BusPlan& plan);

}  // namespace takt
