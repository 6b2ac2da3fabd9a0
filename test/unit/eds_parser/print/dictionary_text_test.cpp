#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <sstream>

#include "eds_parser/print/print_dictionary.hpp"
#include "eds_parser/read/eds.hpp"

namespace takt {
namespace {

using testing::HasSubstr;
using testing::Not;

std::string text_of(const ObjectDictionary& dictionary) {
  std::ostringstream out;
  print_text(out, dictionary);
  return out.str();
}

ObjectDictionary drive() {
  return read_eds_file(TAKT_SOURCE_DIR "/share/eds/takt_drive402.eds", 5_node).dictionary;
}

TEST(DictionaryText, BeginsWithTheDevice) {
  ObjectDictionary dictionary = drive();
  dictionary.file = "drive.eds";

  EXPECT_THAT(
      text_of(dictionary),
      testing::StartsWith("drive.eds  (EDS, node 5)\n\n"
                          "  vendor      takt  0x0000ABCD\n"
                          "  product     takt drive 402  0x00000402  revision 0x00010000\n"
                          "  order code  TAKT-402\n"
                          "  profile     CiA 402, device type 0x00020192\n"
                          "  bit rates   10 20 50 125 250 500 800 1000 kbit/s\n"
                          "  PDOs        4 RPDOs, 4 TPDOs\n"
                          "  file        version 1.1, EDS 4.0, modified 11-20-2026 by takt\n"));
}

TEST(DictionaryText, ShowsEachPdoWithThePlacesOfItsObjects) {
  EXPECT_THAT(text_of(drive()),
              HasSubstr("\nPDOs (directions are the device's: it receives RPDOs)\n"
                        "  RPDO1   0x205      on   type 1   acts at SYNC          48 bits\n"
                        "      byte 0..1   6040:00  Controlword"));
}

TEST(DictionaryText, ShowsEachObjectWithItsValueAndLimits) {
  ObjectDictionary dictionary;
  SubObject speed;
  speed.pdo_mappable = true;
  speed.type = DataType::integer16;
  speed.name = "Speed";
  speed.default_value = std::int64_t{-16};
  speed.default_text = "0xFFF0";
  speed.low_limit = std::int64_t{-100};
  Object& object = dictionary.objects.emplace_back();
  object.index = 0x2000;
  object.name = "Speed";
  object.subs = {speed};

  EXPECT_THAT(text_of(dictionary),
              HasSubstr("\nObjects (1)\n"
                        "  index     name          type            access PDO  "
                        "value (as written)                  limits\n"
                        "  2000      Speed         INTEGER16       rw     PDO  "
                        "-16 (0xFFF0)                        -100..\n"));
  EXPECT_THAT(text_of(dictionary), Not(HasSubstr("References")));
}

TEST(DictionaryText, ShowsWhatADcfSaysOfTheProject) {
  ObjectDictionary dictionary;
  dictionary.is_dcf = true;
  dictionary.commissioning.node_name = "lift";
  dictionary.commissioning.net_number = 1;
  dictionary.modules = {{2, "Digital output", "1", "08", "MOD-DO-8"}, {3, "Analogue", "", "", ""}};
  dictionary.connected_modules = {2, 2};
  dictionary.parameter_references = {{0x2000, std::nullopt, "P 12"}, {0x2001, 3, "P 13"}};
  const std::string text = text_of(dictionary);

  EXPECT_THAT(text, HasSubstr("(DCF)\n"));
  EXPECT_THAT(text, HasSubstr("  profile     unknown\n"));
  EXPECT_THAT(text, HasSubstr("  node name   lift\n  network     number 1\n"));
  EXPECT_THAT(text, HasSubstr("  module      M2  Digital output  version 1.08  MOD-DO-8  "
                              "(2 connected)\n  module      M3  Analogue\n"));
  EXPECT_THAT(text, testing::EndsWith("\nReferences (2)\n"
                                      "  2000      P 12\n"
                                      "  2001:03   P 13\n"));
}

}  // namespace
}  // namespace takt
