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

enum class Command : std::uint8_t { stop = 0, start = 1, clear = 3 };

class ProgramSteps : BootPart {
 public:
  explicit ProgramSteps(const BootPart& part) : BootPart{part} {}

  void check_and_update() {
    const std::string text = "software version " + hex(*spec.software_version, 8);
    BootStep& check = steps.integer(spec.program.empty() ? BootAction::expect : BootAction::compare,
                                    version, *spec.software_version, text);
    check.letter = 'H';
    check.unread_letter = 'G';
    check.running_letter = 'H';
    if (spec.program.empty()) return;
    const std::size_t skip = steps.skip_if_same(text + " is installed");
    update(text);
    steps.land(skip);
  }

 private:
  void update(const std::string& text) {
    command(BootAction::write_if_differs, Command::stop, "stop the program");
    await_answer();
    command(BootAction::write, Command::clear, "clear the program memory");
    await_flash("program memory is clear");
    download();
    await_flash("program is written");
    BootStep& good = steps.integer(BootAction::expect, flash, 0, "flash status after the download");
    good.mask = 0xFE;
    good.optional = true;
    good.letter = 'I';
    steps.integer(BootAction::expect, version, *spec.software_version, text + ", read back")
        .letter = 'I';
    command(BootAction::write, Command::start, "start the program");
    BootStep& runs = steps.integer(BootAction::await_value, control,
                                   static_cast<std::int64_t>(Command::start), "program runs", 1);
    set_restart(runs, start_time);
  }

  /// Marks a step in which the device may restart.
  static void set_restart(BootStep& step, Time timeout) {
    step.letter = 'I';
    step.timeout = timeout;
    step.may_restart = true;
  }

  void command(BootAction action, Command what, const std::string& text) {
    set_restart(steps.integer(action, control, static_cast<std::int64_t>(what), text, 1),
                flash_time);
  }

  /// Waits until the boot loader answers, because it may need time to start.
  void await_answer() {
    set_restart(steps.bytes(BootAction::probe, {0x1000, 0}, {}, "the boot loader answers"),
                start_time);
  }

  void await_flash(const std::string& text) {
    BootStep& step = steps.integer(BootAction::await_value, flash, 0, text);
    step.mask = 1;
    step.optional = true;
    set_restart(step, flash_time);
  }

  void download() {
    BootStep& step =
        steps.bytes(BootAction::download_program, data, spec.program,
                    concat("program ", *spec.software_file, ", ", spec.program.size(), " bytes"));
    step.letter = 'I';
    step.timeout = segment_time;
  }
};

void needs(const BootPart& part, SourcePos pos, std::string_view key, ObjectKey object) {
  part.report.error(pos, "no-such-object", "`", key, "` of node `", part.spec.name, "` needs ",
                    object, ", which its device file does not have");
}

}  // namespace

void append_program(const BootPart& part) {
  const NodeSpec& node = part.spec;
  if (*node.software_version == 0) {
    if (!node.software_file.given) return;
    return part.report.error(
        node.software_file.pos, "missing-key", "`software_file` of node `", node.name,
        "` needs `software_version`, the value of 1F56:01 while this program runs");
  }
  if (!part.steps.has(version)) {
    return needs(part, node.software_version.pos, "software_version", version);
  }
  for (const ObjectKey object : {data, control}) {
    if (node.software_file.given && !part.steps.writable(object)) {
      return needs(part, node.software_file.pos, "software_file", object);
    }
  }
  ProgramSteps{part}.check_and_update();
}

}  // namespace takt
