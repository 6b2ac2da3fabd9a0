#pragma once
#include <cstdint>
#include <expected>
#include <map>
#include <optional>
#include <string>
#include <string_view>
#include <takt/command_t.hpp>
#include <vector>

#include "eds_parser/table/typed_message.hpp"
#include "master/gateway/messages.hpp"
#include "master/gateway/transport.hpp"
#include "master/gateway/units.hpp"
#include "master/rt/process_image.hpp"

namespace takt {

/// BUS_NODE_STATE and BUS_NODE_COMMAND: the image and set-points of one node each, in the types of
/// typed_messages(), encoded as lcm-gen's code would. Front thread.
class TypedChannels {
 public:
  TypedChannels(const BusPlan& plan, std::int64_t session);

  /// The state of every node that has inputs, where somebody hears it. Allocates nothing.
  void publish(const ImageView& image, Time wall_minus_monotonic, Transport& transport);

  /// A message of a command channel as a command_t; outputs that are NaN are left as they are.
  /// None: the channel is none of these.
  std::optional<std::expected<command_t, DecodeFault>> command(std::string_view channel,
                                                               Bytes data) const;

  /// Channels of commands.
  static std::vector<std::string> heard(const BusPlan& plan);

 private:
  struct Type {
    TypedMessage message;
    std::uint64_t fingerprint = 0;
    std::uint64_t fingerprint_of_schema_1 = 0;  // of commands
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
