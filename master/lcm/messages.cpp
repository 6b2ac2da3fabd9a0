#include "master/lcm/messages.hpp"

#include <fmt/format.h>

#include "eds_parser/values/name_of.hpp"

namespace takt {

std::string_view text(DecodeFault fault) noexcept {
  static constexpr std::string_view names[]{
      "the message has schema 1 of an older takt",
      "the publisher has another version of this message type",
      "the bytes of the message are damaged",
      "the message has an infinite number, or a number that does not fit 64 bits"};
  return name_of(fault, names);
}

std::string schema_refusal(std::int16_t schema) {
  return fmt::format("message of schema {}: {} schema {}", schema,
                     schema > message_schema
                         ? "this taktd is older than the application and uses"
                         : "rebuild the application against this takt, which uses",
                     message_schema);
}

std::string daemon_schema_text(std::int16_t schema) {
  return fmt::format("the daemon sends messages of schema {} and this program uses schema {}: {}",
                     schema, message_schema,
                     schema > message_schema ? "rebuild the program against the daemon's takt"
                                             : "update the daemon");
}

}  // namespace takt
