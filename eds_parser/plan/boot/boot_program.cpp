#include "eds_parser/plan/boot/boot_sections.hpp"

namespace takt {
namespace {

constexpr ObjectKey data{0x1F50, 1};
constexpr ObjectKey control{0x1F51, 1};
constexpr ObjectKey version{0x1F56, 1};
constexpr ObjectKey flash{0x1F57, 1};
constexpr Time flash_time = std::chrono::seconds{60};  // longest time of erasing and programming
// Longest time until the boot loader has started the program.
constexpr Time start_time = std::chrono::seconds{10};
// Longest time between two answers of the download.
constexpr Time segment_time = std::chrono::seconds{5};

enum class Command : std::uint8_t { stop = 0, start = 1, clear = 3 };

class ProgramSteps {
 public:
  ProgramSteps(const NodeSpec& node, BootSteps& steps) : node_{node}, steps_{steps} {}

  void check_and_update() {
    const std::string text = "software version " + hex(*node_.software_version, 8);
    BootStep& check =
        steps_.integer(node_.program.empty() ? BootAction::expect : BootAction::compare, version,
                       *node_.software_version, text);
    check.letter = 'H';
    check.unread_letter = 'G';
    check.running_letter = 'H';
    if (node_.program.empty()) return;
    const std::size_t skip = steps_.skip_if_same(text + " is installed");
    update(text);
    steps_.land(skip);
  }

 private:
  void update(const std::string& text) {
    command(BootAction::write_if_differs, Command::stop, "stop the program");
    await_answer();
    command(BootAction::write, Command::clear, "clear the program memory");
    await_flash("program memory is clear");
    download();
    await_flash("program is written");
    BootStep& good =
        steps_.integer(BootAction::expect, flash, 0, "flash status after the download");
    good.mask = 0xFE;
    good.optional = true;
    good.letter = 'I';
    steps_.integer(BootAction::expect, version, *node_.software_version, text + ", read back")
        .letter = 'I';
    command(BootAction::write, Command::start, "start the program");
    BootStep& runs = steps_.integer(BootAction::await_value, control,
                                    static_cast<std::int64_t>(Command::start), "program runs", 1);
    runs.timeout = start_time;
    runs.letter = 'I';
    runs.may_restart = true;
  }

  void command(BootAction action, Command what, const std::string& text) {
    BootStep& step = steps_.integer(action, control, static_cast<std::int64_t>(what), text, 1);
    step.letter = 'I';
    step.may_restart = true;
    step.timeout = flash_time;
  }

  /// Waits until the boot loader answers; it may need time to start.
  void await_answer() {
    BootStep& step = steps_.integer(BootAction::probe, {0x1000, 0}, 0, "the boot loader answers");
    step.value.clear();
    step.letter = 'I';
    step.timeout = start_time;
    step.may_restart = true;
  }

  void await_flash(const std::string& text) {
    BootStep& step = steps_.integer(BootAction::await_value, flash, 0, text);
    step.mask = 1;
    step.optional = true;
    step.letter = 'I';
    step.timeout = flash_time;
    step.may_restart = true;
  }

  void download() {
    BootStep& step = steps_.bytes(
        BootAction::download_program, data, node_.program,
        "program " + *node_.software_file + ", " + std::to_string(node_.program.size()) + " bytes");
    step.letter = 'I';
    step.timeout = segment_time;
  }

  const NodeSpec& node_;
  BootSteps& steps_;
};

void needs(const NodeSpec& node, SourcePos pos, std::string_view key, ObjectKey object,
           NetworkReport& report) {
  report.error(pos, "no-such-object",
               "`" + std::string{key} + "` of node `" + node.name + "` needs " + to_string(object) +
                   ", which its device file does not have");
}

}  // namespace

void append_program(const NodeSpec& node, BootSteps& steps, NetworkReport& report) {
  if (*node.software_version == 0) {
    if (node.software_file.given) {
      report.error(node.software_file.pos, "missing-key",
                   "`software_file` of node `" + node.name +
                       "` needs `software_version`, the value of 1F56:01 while this program runs");
    }
    return;
  }
  if (!steps.has(version)) {
    return needs(node, node.software_version.pos, "software_version", version, report);
  }
  for (const ObjectKey object : {data, control}) {
    if (node.software_file.given && !steps.writable(object)) {
      return needs(node, node.software_file.pos, "software_file", object, report);
    }
  }
  ProgramSteps{node, steps}.check_and_update();
}

}  // namespace takt
