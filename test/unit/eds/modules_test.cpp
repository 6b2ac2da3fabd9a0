#include "eds_parser/modules.hpp"

#include <gtest/gtest.h>

#include "test/unit/eds/eds_text.hpp"

namespace takt {
namespace {

using test::integer;
using test::read;

std::string extension(std::string_view count, std::string_view more = "") {
  return "[SupportedModules]\nNrOfEntries=1\n[M1ModuleInfo]\nProductName=x\n"
         "[M1SubExtends]\nNrOfEntries=1\n1=0x6000\n"
         "[M1SubExt6000]\nParameterName=Input\nDataType=5\nAccessType=ro\nPDOMapping=1\nCount=" +
         std::string{count} + "\n" + std::string{more};
}

std::string connected(int modules) {
  std::string text = "[ConnectedModules]\nNrOfEntries=" + std::to_string(modules) + "\n";
  for (int i = 1; i <= modules; ++i) text += std::to_string(i) + "=1\n";
  return text;
}

// The vectors of CiA 306, 6.
TEST(Modules, EachModuleBringsItsSubObjects) {
  const auto file = read(extension("4") + connected(2));

  EXPECT_EQ(integer(file, {0x6000, 0}), 8);
  EXPECT_EQ(file.dictionary.find(std::uint16_t{0x6000})->subs.size(), 9U);
  EXPECT_TRUE(file.dictionary.find(ObjectKey{0x6000, 8})->pdo_mappable);
}

TEST(Modules, BitsShareASubObjectUntilItIsFull) {
  const auto file = read(extension("0;2") + connected(5));

  EXPECT_EQ(integer(file, {0x6000, 0}), 2);
}

TEST(Modules, ExtensionGoesOnInTheNextObject) {
  const auto file = read(extension("1", "ObjExtend=128\n") + connected(130));

  EXPECT_EQ(integer(file, {0x6000, 0}), 128);
  EXPECT_EQ(integer(file, {0x6001, 0}), 2);
}

TEST(Modules, FixedObjectsComeOnceHoweverManyModulesThereAre) {
  const std::string fixed =
      "[M1FixedObjects]\nNrOfEntries=1\n1=0x6423\n"
      "[M1Fixed6423]\nParameterName=enable\nDataType=1\nAccessType=rw\nDefaultValue=1\n"
      "[M1Fixed2100]\nParameterName=r\nObjectType=9\nSubNumber=2\n"
      "[M1Fixed2100sub0]\nParameterName=n\nDataType=5\nAccessType=ro\nDefaultValue=1\n"
      "[M1Fixed2100sub1]\nParameterName=v\nDataType=6\nAccessType=rw\nDefaultValue=7\n";
  const auto file = read(fixed + connected(3));

  EXPECT_EQ(integer(file, {0x6423, 0}), 1);
  EXPECT_EQ(integer(file, {0x2100, 1}), 7);
}

TEST(Modules, NothingIsPluggedInWithoutConnectedModules) {
  const auto file = read(extension("4"));

  EXPECT_EQ(file.dictionary.find(std::uint16_t{0x6000}), nullptr);
  EXPECT_FALSE(test::has(file.findings, "unknown-section"));
}

TEST(Modules, AnUnknownModuleIsTold) {
  const auto file = read(extension("4") + "[ConnectedModules]\n1=7\n");

  EXPECT_TRUE(test::has(file.findings, "unknown-module"));
}

TEST(Modules, HostileListsAreBounded) {
  std::string text = connected(100'000);
  for (unsigned index = 0x6000; index < 0xA000; ++index) {
    text += "[M1SubExt" + hex(index).substr(2) + "]\nDataType=5\nCount=254\n";
  }
  const auto file = read(text);

  EXPECT_TRUE(test::has(file.findings, "too-many-modules"));
  EXPECT_TRUE(test::has(file.findings, "too-many-sub-objects"));
}

}  // namespace
}  // namespace takt
