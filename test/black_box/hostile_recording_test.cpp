#include <fstream>
#include <gtest/gtest.h>
#include <random>

#include "test/black_box/recorded_run.hpp"
#include "test/support/folder.hpp"

namespace takt {
namespace {

using namespace std::chrono_literals;
using test::Folder;
using test::RecordedRun;

std::string text_of(const std::filesystem::path& path) {
  std::ifstream file{path, std::ios::binary};
  return {std::istreambuf_iterator<char>{file}, {}};
}

void overwrite(const std::filesystem::path& path, const std::string& text) {
  std::ofstream{path, std::ios::binary | std::ios::trunc} << text;
}

/// A good recording, which the tests damage.
class HostileRecording : public testing::Test {
 protected:
  HostileRecording() {
    run.run_until(300ms);
    run.write(folder / "x");
  }
  std::string error() {
    const auto recording = read_recording(folder / "x");
    return recording ? std::string{} : recording.error();
  }
  Folder folder;
  RecordedRun run{"two_axes.yaml"};
};

TEST_F(HostileRecording, NamesAFileThatIsMissing) {
  std::filesystem::remove(folder / "x.journal");
  EXPECT_NE(error().find("x.journal: cannot be read"), std::string::npos) << error();
}

TEST_F(HostileRecording, NamesTheLineOfTheLogThatIsNoFrame) {
  overwrite(folder / "x.log", "(1.000000) can0 080#\nhello\n");
  EXPECT_NE(error().find("x.log:2: not a line"), std::string::npos) << error();
}

TEST_F(HostileRecording, RefusesALogOfAnotherLength) {
  overwrite(folder / "x.log", text_of(folder / "x.log") + "(1.000000) can0 080#\n");
  EXPECT_NE(error().find("do not add or remove any"), std::string::npos) << error();
}

TEST_F(HostileRecording, RefusesEventsThatAreNone) {
  for (const std::string text :
       {"", "{", "[]", "{\"format\":1}", "{\"format\":\"a\"}", "{\"format\":99}", "\xFF\xFE"}) {
    overwrite(folder / "x.events.json", text);
    EXPECT_NE(error().find("not the events of a recording"), std::string::npos) << text;
  }
}

TEST_F(HostileRecording, RefusesAJournalThatIsCutWithinAWord) {
  const std::string journal = text_of(folder / "x.journal");
  overwrite(folder / "x.journal", journal.substr(0, 1003));
  EXPECT_NE(error().find("cut off"), std::string::npos) << error();
  overwrite(folder / "x.journal", "TAKT");
  EXPECT_NE(error().find("not a journal"), std::string::npos) << error();
}

TEST_F(HostileRecording, EndsWithADifferenceWhereTheJournalIsCut) {
  const std::string journal = text_of(folder / "x.journal");
  overwrite(folder / "x.journal", journal.substr(0, 8 + 8 * 500));
  const auto outcome = test::replay_file(run.network.plan, folder / "x");
  EXPECT_TRUE(outcome.difference);
}

TEST_F(HostileRecording, NeitherCrashesNorHangsOnAnyCheckpoint) {
  run.run_until(2s);
  run.write(folder / "middle");
  const auto good = read_recording(folder / "middle");
  ASSERT_TRUE(good);
  ASSERT_FALSE(good->checkpoint.empty());
  std::mt19937_64 random{5};
  for (int round = 0; round < 300; ++round) {
    LoadedRecording recording = *good;
    for (int i = 0; i < 1 + round / 10; ++i) {
      std::uint64_t& word = recording.checkpoint[random() % recording.checkpoint.size()];
      const std::uint64_t wild = round % 3 == 0 ? random() : random() >> random() % 64;
      word = round % 3 == 1 ? word ^ std::uint64_t{1} << random() % 64 : wild;
    }
    replay(run.network.plan, recording, [](const Decision&) {});
  }
}

TEST_F(HostileRecording, NeitherCrashesNorHangsOnAnyWords) {
  const std::string journal = text_of(folder / "x.journal");
  std::mt19937_64 random{3};
  for (int round = 0; round < 200; ++round) {
    auto recording = read_recording(folder / "x");
    ASSERT_TRUE(recording);
    auto& words = recording->parts.front().words;
    for (int i = 0; i < 3; ++i) {
      std::uint64_t& word = words[random() % (round % 2 == 0 ? words.size() : 400)];
      word = round % 3 == 0 ? random() : word ^ std::uint64_t{1} << random() % 64;
    }
    for (int i = 0; i < 3; ++i) {
      Frame& frame =
          recording->parts.front().frames[random() % recording->parts.front().frames.size()];
      frame.data[random() % 8] = static_cast<std::uint8_t>(random());
    }
    replay(run.network.plan, *recording, [](const Decision&) {});
  }
}

}  // namespace
}  // namespace takt
