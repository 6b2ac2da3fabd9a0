#include <CLI/CLI.hpp>
#include <cstdio>
#include <string>

#include "apps/command_line/commands.hpp"
#include "apps/command_line/failure.hpp"
#include "master/lcm/envelope/key_file.hpp"

namespace takt {
namespace {

struct KeysOptions {
  std::string file;
  std::string name = "takt";
};

int make(const KeysOptions& options) {
  value_or_fail(make_key_file(options.file, options.name), 2);
  std::printf("%s: key '%s'\n", options.file.c_str(), options.name.c_str());
  return 0;
}

int check(const KeysOptions& options) {
  for (const EnvelopeKey& key : value_or_fail(load_keys(options.file), 2)) {
    std::printf("%s\n", key.name.c_str());
  }
  return 0;
}

}  // namespace

void add_keys(CLI::App& app, int& exit_code) {
  auto* verb =
      app.add_subcommand("keys", "makes and checks key files, which decide who may command a bus");
  verb->require_subcommand(1);
  verb->footer(
      "Without keys every program that reaches LCM can command the bus. With `lcm: {keys: FILE}`\n"
      "in the network file taktd accepts commands, requests and files only in envelopes.\n"
      "Programs make these envelopes with the first key of the file in TAKT_KEYS or --keys.\n\n"
      "Example:\n"
      "  takt keys new lift.keys && export TAKT_KEYS=$PWD/lift.keys");
  auto [fresh, options] = add_command<KeysOptions>(
      *verb, exit_code, "new", "makes a file with one new random key, mode 0600", make);
  fresh.add_option("FILE", options.file, "key file to make; the file must not exist yet")
      ->required();
  fresh.add_option("--name", options.name, "name of the key")->capture_default_str();
  auto [look, check_options] = add_command<KeysOptions>(
      *verb, exit_code, "check",
      "checks permissions and contents, and prints the names of the keys", check);
  look.add_option("FILE", check_options.file, "the key file")->required();
}

}  // namespace takt
