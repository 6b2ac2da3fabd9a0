#pragma once
#include <cstdint>
#include <expected>
#include <map>
#include <optional>
#include <string>
#include <string_view>
#include <takt/command_t.hpp>
#include <takt/lcm.hpp>
#include <vector>

#include "eds_parser/lcm/typed_message.hpp"
#include "master/lcm/messages.hpp"
#include "master/rt/exchange/process_image.hpp"
#include "master/units/units.hpp"

namespace takt {

/// BUS_NODE_STATE and BUS_NODE_COMMAND: the image and the set-points of one node each, in the types
/// of typed_messages() and with the encoding of lcm-gen's code. All calls come from the front
/// thread.
class TypedChannels {
 public:
  TypedChannels(const BusPlan& plan, std::int64_t session);

  /// Publishes the state of every node that has inputs, if a subscriber receives it. Allocates
  /// nothing.
  void publish(const ImageView& image, Time wall_minus_monotonic, Transport& transport);

  /// Converts a message of a command channel to a command_t and leaves out outputs that are NaN.
  /// Returns std::nullopt if the channel is not a command channel.
  std::optional<std::expected<command_t, DecodeFault>> command(std::string_view channel,
                                                               Bytes data) const;
  /// Returns the index of the node of a command channel; std::nullopt for other channels.
  std::optional<std::size_t> node_of(std::string_view channel) const;

  /// Returns the channels on which commands come.
  static std::vector<std::string> heard(const BusPlan& plan);

 private:
  struct Type {
    TypedMessage message;
    std::uint64_t fingerprint = 0;
    std::uint64_t fingerprint_of_schema_1 = 0;  // only for commands
  };

  void encode(const Type& state, const ImageView& image, Time wall_minus_monotonic);
  void encode(const TypedField& field, std::int64_t raw);
  std::expected<command_t, DecodeFault> decode(const Type& type, Bytes data) const;

  Units units_;
  std::int64_t session_;
  std::vector<Type> states_;
  std::map<std::string, Type, std::less<>> commands_;
  std::vector<std::byte> buffer_;
};

}  // namespace takt
