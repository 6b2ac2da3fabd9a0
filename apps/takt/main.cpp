#include "apps/takt/commands.hpp"

int main(int argc, char** argv) {
  CLI::App app{"takt - CANopen from the command line", "takt"};
  app.require_subcommand(1);
  app.get_formatter()->column_width(34);
  int exit_code = 0;
  takt::add_dump(app, exit_code);
  takt::add_eds(app, exit_code);
  takt::add_plan(app, exit_code);
  takt::add_sim(app, exit_code);
  takt::add_simulate(app, exit_code);
  takt::add_status(app, exit_code);
  takt::add_top(app, exit_code);
  takt::add_sdo(app, exit_code);
  takt::add_nmt(app, exit_code);
  try {
    app.parse(argc, argv);
  } catch (const CLI::ParseError& error) {
    return app.exit(error) == 0 ? 0 : 2;
  }
  return exit_code;
}
