#include "eds_parser/read/modules.hpp"

#include <gtest/gtest.h>

#include "test/unit/eds_parser/read/eds_text.hpp"

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

TEST(Modules, SubZeroCountsWhatTheyBringWhetherTheFileDescribesItOrNot) {
  const std::string module = extension("1") + connected(1);
  const std::string own =
      "[6000]\nParameterName=x\nObjectType=9\n[6000sub0]\nDataType=5\nAccessType=ro\n";
  const std::string first = "[6000sub1]\nDataType=5\nAccessType=ro\n";
  for (const auto* count : {"DefaultValue=0\n", "DefaultValue=two\n", ""}) {
    const auto brought = read(module + own + count);
    const auto described = read(module + own + count + first);
    ASSERT_TRUE(brought.dictionary.find({0x6000, 0}));
    EXPECT_EQ(brought.dictionary.find({0x6000, 0})->default_value,
              described.dictionary.find({0x6000, 0})->default_value)
        << count;
  }
}

TEST(Modules, SayWhatTheyAreAndWhichAreConnected) {
  const auto file = read(
      "[M10ModuleInfo]\nProductName=Analogue\n"
      "[M2ModuleInfo]\nProductName=Digital\nProductVersion=1\nProductRevision=08\n"
      "OrderCode=MOD-DI-8\n"
      "[M2ModuleInfo]\nProductName=again\n"
      "[M2SubExt6000]\nParameterName=Input\nDataType=5\nAccessType=ro\nCount=1\n"
      "[M10SubExt6401]\nParameterName=Value\nDataType=3\nAccessType=ro\nCount=2\n"
      "[ConnectedModules]\nNrOfEntries=4\n1=2\n2=10\n3=7\n4=2\n");

  const auto& modules = file.dictionary.modules;
  ASSERT_EQ(modules.size(), 2U);
  EXPECT_EQ(modules[0].number, 2);
  EXPECT_EQ(modules[0].product_name, "Digital");
  EXPECT_EQ(modules[0].product_version, "1");
  EXPECT_EQ(modules[0].product_revision, "08");
  EXPECT_EQ(modules[0].order_code, "MOD-DI-8");
  EXPECT_EQ(modules[1].number, 10);
  EXPECT_EQ(modules[1].product_name, "Analogue");
  EXPECT_EQ(file.dictionary.connected_modules, (std::vector<std::uint16_t>{2, 10, 7, 2}));
  ASSERT_TRUE(test::has(file.findings, "duplicate-section"));
  EXPECT_EQ(test::find(file.findings, "duplicate-section")->pos.line, test::line_of(8));
}

TEST(Modules, FixedObjectsMayHaveFiles) {
  const auto file = read(
      "[M1Fixed2F50]\nParameterName=Program\nObjectType=2\nDataType=0xF\nAccessType=rw\n"
      "DownloadFile=app.bin\nParamRefd=K1\n" +
      connected(1));

  ASSERT_EQ(file.dictionary.domain_files.size(), 1U);
  EXPECT_EQ(file.dictionary.domain_files[0].download, "app.bin");
  ASSERT_EQ(file.dictionary.parameter_references.size(), 1U);
  EXPECT_EQ(file.dictionary.parameter_references[0].index, 0x2F50);
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

TEST(Modules, FixedObjectsHaveTheListsOfShortNotation) {
  const std::string fixed =
      "[M1Fixed2100]\nParameterName=gain\nObjectType=8\nDataType=6\nAccessType=rw\n"
      "DefaultValue=7\nCompactSubObj=3\n"
      "[M1Fixed2100Name]\nNrOfEntries=1\n2=Proportional\n"
      "[M1Fixed2100Value]\nNrOfEntries=1\n3=0x20\n"
      "[M1Fixed2100Denotation]\nNrOfEntries=1\n1=first\n";
  const auto file = read(fixed + connected(1));

  EXPECT_EQ(file.dictionary.find(ObjectKey{0x2100, 2})->name, "Proportional");
  EXPECT_EQ(integer(file, {0x2100, 2}), 7);
  EXPECT_EQ(integer(file, {0x2100, 3}), 32);
  EXPECT_EQ(file.dictionary.find(ObjectKey{0x2100, 1})->denotation, "first");
}

TEST(Modules, SectionsOfNoUseAreReported) {
  const auto lonely = read("[M1Fixed2100Name]\n1=x\n" + extension("1") + connected(1));
  const auto lists = read(extension("1") + "[M1SubExt6000Name]\n1=x\n" + connected(1));
  const auto odd = read(extension("1") + "[M1FixedThings]\n1=x\n");

  ASSERT_TRUE(test::has(lonely.findings, "object-section-missing"));
  EXPECT_EQ(test::find(lonely.findings, "object-section-missing")->pos.line, test::line_of(1));
  EXPECT_EQ(lonely.dictionary.find(std::uint16_t{0x2100}), nullptr);
  EXPECT_TRUE(test::has(lists.findings, "unknown-section"));
  EXPECT_TRUE(test::has(odd.findings, "unknown-section"));
}

TEST(Modules, ABlankBeforeSubIsReported) {
  const auto file = read(
      "[M1Fixed2100]\nParameterName=r\nObjectType=9\nSubNumber=1\n"
      "[M1Fixed2100 sub1]\nParameterName=v\nDataType=6\nAccessType=rw\nDefaultValue=7\n" +
      connected(1));

  EXPECT_EQ(integer(file, {0x2100, 1}), 7);
  EXPECT_TRUE(test::has(file.findings, "section-name-blank"));
}

TEST(Modules, NothingIsPluggedInWithoutConnectedModules) {
  const auto file = read(extension("4"));

  EXPECT_EQ(file.dictionary.find(std::uint16_t{0x6000}), nullptr);
  EXPECT_FALSE(test::has(file.findings, "unknown-section"));
}

TEST(Modules, StandInTheOrderOfTheirNumbers) {
  const auto module = [](const char* number, const char* name) {
    return "[M" + std::string{number} + "SubExt6000]\nParameterName=" + name +
           "\nDataType=5\nAccessType=ro\nCount=1\n";
  };
  const auto modules = module("1", "Input") + module("2", "Output");
  const auto file = read(modules + "[ConnectedModules]\nNrOfEntries=3\n10=1\n2=1\n1=2\n");

  EXPECT_EQ(file.dictionary.find(ObjectKey{0x6000, 1})->name, "Output1");
  EXPECT_EQ(file.dictionary.find(ObjectKey{0x6000, 2})->name, "Input2");
  EXPECT_EQ(file.dictionary.find(ObjectKey{0x6000, 3})->name, "Input3");
  EXPECT_FALSE(test::has(file.findings, "module-count"));
}

TEST(Modules, EntriesThatDoNotFitTheirListAreReported) {
  const auto more = read(extension("1") + "[ConnectedModules]\nNrOfEntries=1\n1=1\n2=1\n");
  const auto twice = read(extension("1") + "[ConnectedModules]\nNrOfEntries=2\n1=1\n1=1\n");
  const auto other = read(extension("1") + "[ConnectedModules]\nNr Of Entries=1\n1=1\n");

  ASSERT_TRUE(test::has(more.findings, "module-count"));
  EXPECT_EQ(test::find(more.findings, "module-count")->pos.column, 13U);
  EXPECT_EQ(integer(more, {0x6000, 0}), 2);
  EXPECT_TRUE(test::has(twice.findings, "duplicate-key"));
  EXPECT_EQ(integer(twice, {0x6000, 0}), 1);
  EXPECT_TRUE(test::has(other.findings, "unknown-key"));
  EXPECT_EQ(integer(other, {0x6000, 0}), 1);
}

TEST(Modules, AnUnknownModuleIsReported) {
  const auto file = read(extension("4") + "[ConnectedModules]\n1=7\n");

  EXPECT_TRUE(test::has(file.findings, "unknown-module"));
}

TEST(Modules, SubObjectsThatTheFileDescribesTooAreReported) {
  std::string described = "[6000]\nParameterName=r\nObjectType=8\nSubNumber=3\n";
  for (const char* sub : {"0", "1", "2"}) {
    described += "[6000sub" + std::string{sub} + "]\nParameterName=s\nDataType=5\nAccessType=ro\n";
  }
  const auto fewer = read(described + extension("2") + connected(2));
  const auto same = read(described + extension("2") + connected(1));

  EXPECT_EQ(fewer.dictionary.find(std::uint16_t{0x6000})->subs.size(), 5U);
  EXPECT_TRUE(test::has(fewer.findings, "module-sub-objects"));
  EXPECT_FALSE(test::has(same.findings, "module-sub-objects"));
}

TEST(Modules, FixedObjectsStandAmongThoseOfTheFileInOrder) {
  std::string text = connected(1);
  for (unsigned index = 0x5000; index < 0x9000; ++index) {
    text += "[M1Fixed" + hex(index).substr(2) + "]\nParameterName=m\nDataType=5\nAccessType=rw\n";
  }
  text +=
      "[5010]\nParameterName=own\nDataType=6\nAccessType=rw\n[A000]\nParameterName=last\n"
      "DataType=6\nAccessType=rw\n";
  const auto file = read(text);

  EXPECT_EQ(file.dictionary.objects.size(), 3U + 0x4000 + 1);
  EXPECT_TRUE(std::ranges::is_sorted(file.dictionary.objects, {}, &Object::index));
  EXPECT_EQ(file.dictionary.find(std::uint16_t{0x5010})->name, "own");
  EXPECT_EQ(file.dictionary.find(std::uint16_t{0xA000})->name, "last");
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

TEST(Modules, ThatAreNotConnectedMayHaveAnyNumberOfCompactObjects) {
  std::string text;
  for (int type = 1; type <= 1100; ++type) {
    const std::string object = "[M" + std::to_string(type) + "Fixed2000";
    text += object +
            "]\nParameterName=a\nObjectType=8\nDataType=5\nAccessType=rw\nCompactSubObj=254\n" +
            object + "Name]\nNrOfEntries=1\n1=first\n";
  }
  text +=
      "[M1101Fixed2000]\nParameterName=a\nObjectType=8\nDataType=5\nAccessType=rw\n"
      "CompactSubObj=254\nDefaultValue=010\n";

  const auto findings = read(text).findings;

  EXPECT_FALSE(test::has(findings, "too-many-sub-objects"));
  EXPECT_FALSE(test::has(findings, "unknown-sub-object"));
  EXPECT_TRUE(test::has(findings, "octal-number"));
}

}  // namespace
}  // namespace takt
