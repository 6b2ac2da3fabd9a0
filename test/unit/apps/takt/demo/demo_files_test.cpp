#include "apps/takt/demo/demo_files.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "test/support/folder.hpp"

namespace takt {
namespace {

using testing::HasSubstr;

TEST(DemoFiles, StandBesideTheProgramBelowAnyPrefix) {
  const test::Folder folder;
  for (const char* file :
       {"p/bin/takt", "p/bin/taktd", "p/bin/takt-move", "p/share/takt/demo/two_axes.yaml"}) {
    folder.write(file, "");
  }
  const auto prefix = folder.path() / "p";
  const auto files = find_demo_files(prefix / "bin/takt");
  ASSERT_TRUE(files) << files.error();
  EXPECT_EQ(files->taktd, prefix / "bin/taktd");
  EXPECT_EQ(files->takt_move, prefix / "bin/takt-move");
  EXPECT_EQ(files->network, prefix / "share/takt/demo/two_axes.yaml");

  std::filesystem::remove(files->network);
  const auto without = find_demo_files(prefix / "bin/takt");
  ASSERT_FALSE(without);
  EXPECT_THAT(without.error(), HasSubstr("share/takt/demo/two_axes.yaml is missing"));
}

}  // namespace
}  // namespace takt
