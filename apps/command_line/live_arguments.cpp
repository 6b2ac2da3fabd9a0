#include "apps/command_line/live_arguments.hpp"

#include <CLI/CLI.hpp>
#include <cstdio>

#include "eds_parser/values/number_in.hpp"
#include "master/lcm/printable_text.hpp"

namespace takt {

void add_bus_choice(CLI::App& verb, LiveOptions& options) {
  verb.add_option("--lcm-url", options.lcm_url, "LCM URL of the daemon; default: LCM_DEFAULT_URL")
      ->type_name("URL");
  verb.add_option("--bus-name", options.bus_name, "name of the bus, if there are several")
      ->type_name("NAME");
}

void add_key_options(CLI::App& app, std::string& keys, bool& check_images) {
  app.add_option("--keys", keys, "key file, if the daemon has one; default: TAKT_KEYS")
      ->type_name("FILE")
      ->envname("TAKT_KEYS");
  app.add_flag("--check-images", check_images,
               "accept only messages that the daemon has signed (see\n"
               "`authenticate: images`); TAKT_CHECK_IMAGES=true does the same")
      ->envname("TAKT_CHECK_IMAGES");
}

void add_live_options(CLI::App& verb, LiveOptions& options) {
  add_bus_choice(verb, options);
  verb.add_flag("--json", options.json, "print JSON");
  add_key_options(verb, options.keys, options.check_images);
}

std::optional<std::uint32_t> parse_unsigned(std::string_view text, int base) {
  if (text.starts_with("0x") || text.starts_with("0X")) {
    text.remove_prefix(2);
    base = 16;
  }
  return number_in<std::uint32_t>(text, base);
}

std::optional<ObjectKey> parse_object(std::string_view text) {
  const std::size_t colon = text.find(':');
  const auto index = parse_unsigned(text.substr(0, colon), 16);
  const auto sub =
      colon == text.npos ? std::optional{0U} : parse_unsigned(text.substr(colon + 1), 16);
  if (!index || !sub || *index > 0xFFFF || *sub > 0xFF) return std::nullopt;
  return ObjectKey{static_cast<std::uint16_t>(*index), static_cast<std::uint8_t>(*sub)};
}

std::optional<NodeId> parse_node_id(std::string_view text) {
  const auto value = parse_unsigned(text);
  return value ? NodeId::from(*value) : std::nullopt;
}

int complain(const std::string& sentence, int code) {
  std::fprintf(stderr, "takt: %s\n", printable_lines(sentence).c_str());
  return code;
}

}  // namespace takt
