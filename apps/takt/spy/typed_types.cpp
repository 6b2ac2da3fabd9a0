#include "apps/takt/spy/typed_types.hpp"

#include "eds_parser/lcm/typed_message.hpp"

namespace takt::spy {

TypedChannels add_typed(MessageTypes& types, const BusPlan& plan) {
  TypedChannels channels;
  for (const TypedMessage& message : typed_messages(plan)) {
    std::vector<Member>& members = types[message.name];
    members.clear();
    for (const TypedField& field : message.fields) {
      members.push_back(
          {.type = std::string{name(field.type)}, .name = field.name, .comment = field.comment});
    }
    channels[message.channel] = {message.name, message.fingerprint()};
  }
  return channels;
}

}  // namespace takt::spy
