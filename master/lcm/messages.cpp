#include "master/lcm/messages.hpp"

#include "eds_parser/table/name_of.hpp"

namespace takt {

std::string_view text(DecodeFault fault) noexcept {
  static constexpr std::string_view names[]{
      "the message has schema 1 of an older takt",
      "the publisher has another version of this message type",
      "the bytes of the message are damaged",
      "the message has an infinite number, or a number that does not fit 64 bits"};
  return name_of(fault, names);
}

namespace {

std::string schema_text(std::int16_t schema) { return "schema " + std::to_string(schema); }

}  // namespace

std::string schema_refusal(std::int16_t schema) {
  const bool newer = schema > message_schema;
  return "message of " + schema_text(schema) + ": " +
         (newer ? "this taktd is older than the application and uses "
                : "rebuild the application against this takt, which uses ") +
         schema_text(message_schema);
}

std::string daemon_schema_text(std::int16_t schema) {
  const bool newer = schema > message_schema;
  return "the daemon sends messages of " + schema_text(schema) + " and this program uses " +
         schema_text(message_schema) + ": " +
         (newer ? "rebuild the program against the daemon's takt" : "update the daemon");
}

}  // namespace takt
