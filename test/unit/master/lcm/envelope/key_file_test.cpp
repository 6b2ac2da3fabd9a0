#include "master/lcm/envelope/key_file.hpp"

#include <filesystem>
#include <fstream>
#include <gtest/gtest.h>
#include <sys/stat.h>
#include <vector>

#include "test/support/folder.hpp"
#include "test/support/no_descriptor_left.hpp"

namespace takt {
namespace {

const std::string zeros(64, '0');
const std::string ones(64, '1');

class KeyFileTest : public testing::Test {
 protected:
  void write(const std::string& text, mode_t mode = 0600) {
    // A new file each time: the time stamps of two writes may be equal, the inodes are not.
    const std::string next = path + ".next";
    std::ofstream{next} << text;
    ASSERT_EQ(::chmod(next.c_str(), mode), 0);
    std::filesystem::rename(next, path);
  }
  std::string error() const {
    const auto keys = load_keys(path);
    return keys ? "" : keys.error();
  }

  const test::Folder folder_;
  const std::string path = folder_ / "lift.keys";
};

TEST_F(KeyFileTest, HasSeveralKeysWithNames) {
  write("# who may move the lift\nplant " + zeros + "\n\n  desk\t" + ones +
        "  # of the workshop\r\n");

  const auto keys = load_keys(path);

  ASSERT_TRUE(keys) << keys.error();
  ASSERT_EQ(keys->size(), 2U);
  EXPECT_EQ((*keys)[0].name, "plant");
  EXPECT_EQ((*keys)[1].name, "desk");
  EXPECT_EQ((*keys)[1].secret[31], 0x11);
}

TEST_F(KeyFileTest, ThatOthersCanUseIsRefusedWithTheCommandThatMendsIt) {
  for (const mode_t mode : {0640U, 0604U, 0620U, 0602U, 0610U}) {
    write("plant " + zeros + "\n", mode);
    EXPECT_EQ(error(),
              "key file " + path + ": users other than its owner can access it: chmod 600 " + path);
  }
  write("plant " + zeros + "\n", 0400);
  EXPECT_EQ(error(), "");
}

TEST_F(KeyFileTest, ThatIsNoRegularFileIsRefused) {
  std::filesystem::create_directory(path);
  EXPECT_EQ(error(), "key file " + path + ": it is not a regular file");
  std::filesystem::remove(path);
  ASSERT_EQ(::mkfifo(path.c_str(), 0600), 0);
  EXPECT_EQ(error(), "key file " + path + ": it is not a regular file");
  std::filesystem::remove(path);
  std::ofstream{folder_ / "real"} << "plant " + zeros;
  std::filesystem::create_symlink(folder_ / "real", path);
  EXPECT_EQ(error(), "key file " + path + ": it is not a regular file");
  std::filesystem::remove(path);
  EXPECT_EQ(error(), "key file " + path + ": No such file or directory");
}

TEST_F(KeyFileTest, ErrorsNameTheLine) {
  const std::string here = "key file " + path + ":2: ";
  const std::vector<std::string> wrong{"plant",
                                       "plant 00",
                                       "plant " + zeros + "00",
                                       "plant -" + zeros,
                                       "plant " + zeros.substr(1) + "g",
                                       "plant " + zeros + " more"};
  for (const std::string& line : wrong) {
    write("\n" + line + "\n");
    EXPECT_EQ(error(), here + "expected a name and 64 hex digits") << line;
  }
  write(
      "\npl\x1B"
      "ant " +
      zeros + "\n");
  EXPECT_EQ(error(), here + "a name has 1 to 32 letters, digits, underscores, dashes or dots");
  write("a " + zeros + "\na " + ones + "\n");
  EXPECT_EQ(error(), here + "key 'a' occurs twice");
  write("# nothing\n");
  EXPECT_EQ(error(), "key file " + path + ": the file has no key");
  write(std::string(70000, ' '));
  EXPECT_EQ(error(), "key file " + path + ": the file is longer than 64 KiB");
}

TEST_F(KeyFileTest, IsMadeForItsOwnerOnlyAndNeverOverAnother) {
  ASSERT_TRUE(make_key_file(path, "desk"));
  struct stat status{};
  ASSERT_EQ(::stat(path.c_str(), &status), 0);
  EXPECT_EQ(status.st_mode & 0777U, 0600U);
  const auto keys = load_keys(path);
  ASSERT_TRUE(keys) << keys.error();
  EXPECT_EQ((*keys)[0].name, "desk");

  const auto again = make_key_file(path, "desk");
  ASSERT_FALSE(again);
  EXPECT_EQ(again.error(), "key file " + path + ": File exists");
  EXPECT_FALSE(make_key_file(folder_ / "other", "a b"));
}

TEST_F(KeyFileTest, IsReadAgainWhenItChangesAndKeepsItsKeysWhenItCantBe) {
  write("plant " + zeros + "\n");
  auto file = WatchedKeyFile::open(path);
  ASSERT_TRUE(file) << file.error();
  EXPECT_FALSE(file->reread());

  write("desk " + ones + "\n");
  auto read = file->reread();
  ASSERT_TRUE(read);
  EXPECT_TRUE(*read);
  EXPECT_EQ(file->keys()[0].name, "desk");

  write("plant " + zeros + "\n", 0644);
  read = file->reread();
  ASSERT_TRUE(read);
  EXPECT_FALSE(*read);
  EXPECT_EQ(file->keys()[0].name, "desk");
  EXPECT_FALSE(file->reread()) << "it is told once";

  std::filesystem::remove(path);
  read = file->reread();
  ASSERT_TRUE(read);
  EXPECT_FALSE(*read);
  EXPECT_EQ(file->keys()[0].name, "desk");
}

TEST_F(KeyFileTest, IsTriedAgainWhileNoDescriptorIsLeftAndTheErrorIsReportedOnce) {
  write("plant " + zeros + "\n");
  auto file = WatchedKeyFile::open(path);
  ASSERT_TRUE(file) << file.error();
  write("desk " + ones + "\n");
  {
    const test::NoDescriptorLeft none;
    const auto read = file->reread();
    ASSERT_TRUE(read);
    ASSERT_FALSE(*read);
    EXPECT_EQ(read->error(), "key file " + path + ": Too many open files");
    EXPECT_FALSE(file->reread()) << "it is told once";
    EXPECT_EQ(file->keys()[0].name, "plant");
  }

  const auto read = file->reread();
  ASSERT_TRUE(read) << "the file is the same, but it was not read yet";
  EXPECT_TRUE(*read);
  EXPECT_EQ(file->keys()[0].name, "desk");
  EXPECT_FALSE(file->reread());
}

}  // namespace
}  // namespace takt
