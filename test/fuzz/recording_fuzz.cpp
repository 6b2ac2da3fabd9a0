#include <array>
#include <cstddef>
#include <cstdint>
#include <cstring>
#include <fstream>
#include <string>
#include <string_view>

#include "master/black_box/recording_file.hpp"
#include "master/black_box/replay.hpp"
#include "test/black_box/recorded_run.hpp"
#include "test/fuzz/input.hpp"
#include "test/support/folder.hpp"

namespace {

using takt::fuzz::demand;
using takt::fuzz::Input;

/// A good recording that begins with the start of the master, and one that begins in the middle of
/// its run, with a checkpoint.
class GoodRecordings {
 public:
  GoodRecordings() {
    run_.run_until(std::chrono::milliseconds{300});
    run_.write(folder_ / "start");
    run_.run_until(std::chrono::milliseconds{1500});
    run_.write(folder_ / "middle");
    read_[0] = takt::read_recording(folder_ / "start").value();
    read_[1] = takt::read_recording(folder_ / "middle").value();
    demand(!read_[0].fault && !read_[1].fault && !read_[1].checkpoint.empty());
  }
  const takt::LoadedRecording& of(std::uint8_t which) const { return read_[which % 2]; }
  const takt::BusPlan& plan() const { return run_.network.plan; }
  const takt::test::Folder& folder() const { return folder_; }

 private:
  takt::test::Folder folder_;
  takt::test::RecordedRun run_{"two_axes.yaml", {}, 1 << 20};
  std::array<takt::LoadedRecording, 2> read_;
};

const GoodRecordings& good() {
  static const GoodRecordings made;
  return made;
}

void play(const takt::LoadedRecording& recording) {
  std::uint64_t reported = 0;
  const auto outcome = takt::replay(good().plan(), recording, [&](const auto&) { ++reported; });
  demand(!outcome.difference || !outcome.difference->empty());
}

void change(std::vector<std::uint64_t>& words, Input& input) {
  if (words.empty()) return;
  std::uint64_t& word = words[input.number(2) % words.size()];
  const std::uint8_t how = input.byte();
  word = how < 64 ? word ^ std::uint64_t{1} << how : input.number(how % 9);
}

/// Changes some words, frames or ends of a good recording, and replays it.
void change_and_play(Input& input, std::uint8_t which) {
  takt::LoadedRecording recording = good().of(which);
  auto& part = recording.parts.front();
  while (!input.empty()) {
    switch (input.byte() % 4) {
      case 0:
        change(part.words, input);
        break;
      case 1:
        change(recording.checkpoint, input);
        break;
      case 2: {
        takt::Frame& frame = part.frames[input.number(2) % part.frames.size()];
        frame.data[input.byte() % 8] = input.byte();
        frame.length = static_cast<std::uint8_t>(input.byte() % 9);
        break;
      }
      default:
        part.words.resize(input.number(2) % (part.words.size() + 1));
    }
  }
  play(recording);
}

/// Makes the three files of a recording from any bytes. In the input, each file but the last
/// follows its length.
void read_and_play(Input& input) {
  const auto stem = good().folder() / "any";
  for (const char* ending : {".events.json", ".journal", ".log"}) {
    std::ofstream file{stem.string() + ending, std::ios::binary | std::ios::trunc};
    const bool last = std::strcmp(ending, ".log") == 0;
    const std::string_view text = input.text(last ? input.size() : input.number(2));
    if (std::strcmp(ending, ".journal") == 0 && !text.starts_with('!')) file << "TAKTJNL1";
    file << text;
  }
  const auto recording = takt::read_recording(stem);
  if (!recording) return demand(!recording.error().empty());
  if (!recording->fault) play(*recording);
}

}  // namespace

/// Reads any files as a recording of the black box, or changes a good recording, and replays it.
extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  Input input{data, size};
  const std::uint8_t which = input.byte();
  if (which % 4 == 0) {
    read_and_play(input);
  } else {
    change_and_play(input, which);
  }
  return 0;
}
