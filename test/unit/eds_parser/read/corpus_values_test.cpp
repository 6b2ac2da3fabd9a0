#include <algorithm>
#include <cstdio>
#include <gtest/gtest.h>

#include "eds_parser/read/eds.hpp"
#include "test/unit/eds_parser/read/device_files.hpp"
#include "test/unit/eds_parser/read/plain_ini.hpp"

namespace takt {
namespace {

using test::plain_number;
using test::PlainSection;
using test::text_of;

constexpr NodeId node = 1_node;
const std::optional<Value> none;

struct Compared {
  unsigned files = 0;
  unsigned objects = 0;
  unsigned subs = 0;
  unsigned names = 0;
  unsigned defaults = 0;
  unsigned limits = 0;
  unsigned parameters = 0;
};

/// Converts a number to its type. A bit pattern stands for a negative number, and a negative number
/// of an unsigned type stands for its bit pattern. A number that needs more bits is no value.
std::optional<Value> in_type(const test::PlainNumber& number, DataType type) {
  const unsigned spare = 64 - bit_width(type);
  const auto extended = static_cast<std::int64_t>(number.bits << spare) >> spare;
  const auto pattern = number.bits << spare >> spare;
  const bool fits = number.negative
                        ? extended < 0 && static_cast<std::uint64_t>(extended) == number.bits
                        : pattern == number.bits;
  if (!fits) return std::nullopt;
  if (is_signed(type)) return Value{extended};
  return Value{pattern};
}

bool is_integer(DataType type) {
  return type != DataType::boolean && type <= DataType::unsigned64 && !is_real(type) &&
         !is_bytes(type) && type != DataType::time_of_day && type != DataType::time_difference;
}

bool is_ascii(std::string_view text) {
  return std::ranges::all_of(text, [](char c) { return c >= ' ' && c <= '~'; });
}

/// The limits of an object. Limits without a range between them are ignored. A limit that is too
/// large for a signed type, and may be a bit pattern, may be ignored too.
struct Limits {
  bool inverted = false;
  bool low_above = false;
  bool high_above = false;

  bool is_left_out(std::string_view what) const {
    return inverted && (what == "lowlimit" || what == "highlimit");
  }
  bool may_be_left_out(std::string_view what) const {
    return (low_above && what == "lowlimit") || (high_above && what == "highlimit");
  }
};

Limits limits_of(const PlainSection& section, DataType type) {
  const auto low = plain_number(text_of(section, "lowlimit"), node.value());
  const auto high = plain_number(text_of(section, "highlimit"), node.value());
  const auto above = [&](const std::optional<test::PlainNumber>& limit) {
    const bool positive = limit && !limit->negative;
    return positive && is_signed(type) && (limit->bits >> (bit_width(type) - 1)) != 0;
  };
  const auto lowest = low ? in_type(*low, type) : none;
  const auto highest = high ? in_type(*high, type) : none;
  return {.inverted = lowest && highest && *lowest > *highest,
          .low_above = above(low),
          .high_above = above(high)};
}

/// Compares the values in one file with the result of eds_parser.
class Judge {
 public:
  Judge(const std::filesystem::path& path, Compared& compared)
      : path_{path},
        compared_{compared},
        ini_{test::read_plain_ini(path)},
        dictionary_{read_eds_file(path, node).dictionary} {}

  void run() {
    ++compared_.files;
    for (const auto& [name, section] : ini_) {
      const auto key = test::plain_key(name);
      if (!key) continue;
      const auto* object = dictionary_.find(key->index);
      ++compared_.objects;
      EXPECT_NE(object, nullptr) << path_ << " [" << name << ']';
      if (object == nullptr) continue;
      if (!key->sub) {
        compare_name(name, section, object->name);
        judge_object(name, section, *object);
      } else {
        judge_sub(name, section, {key->index, *key->sub});
      }
    }
  }

 private:
  /// Compares the values in the section of the object itself, which belong to a VAR or to all
  /// entries of a compact list.
  void judge_object(const std::string& name, const PlainSection& section, const Object& object) {
    const auto subs = ini_.lower_bound(name + "sub");
    if (subs != ini_.end() && subs->first.starts_with(name + "sub")) return;
    const auto compact = plain_number(text_of(section, "compactsubobj"), node.value());
    if (compact && compact->bits != 0) {
      judge_compact(name, section, object.index, compact->bits);
    } else if (object.type == ObjectType::var) {
      compare(name, section, {object.index, 0});
    }
  }

  /// The last entry of a compact list is 254. With CompactSubObj=255 the last one would be
  /// sub-index 255, which holds the structure of the object.
  void judge_compact(const std::string& name, const PlainSection& section, std::uint16_t index,
                     std::uint64_t count) {
    const auto last = std::min<std::uint64_t>(count, 254);
    const PlainSection number{{"datatype", "5"}, {"defaultvalue", std::to_string(last)}};
    compare(name, number, {index, 0});
    const auto values = ini_.find(name + "value");
    for (std::uint64_t sub = 1; sub <= last; ++sub) {
      PlainSection entry = section;
      const auto text = values == ini_.end() ? "" : text_of(values->second, std::to_string(sub));
      if (!text.empty()) entry["parametervalue"] = text;
      compare(name, entry, {index, static_cast<std::uint8_t>(sub)});
    }
  }

  /// A value in [xxxxValue] also counts beside sections of sub-objects.
  void judge_sub(const std::string& name, const PlainSection& section, ObjectKey key) {
    PlainSection with_value = section;
    const auto values = ini_.find(name.substr(0, 4) + "value");
    const auto text =
        values == ini_.end() ? "" : text_of(values->second, std::to_string(unsigned{key.sub}));
    if (!text.empty()) with_value["parametervalue"] = text;
    const auto* sub = compare(name, with_value, key);
    if (sub != nullptr) compare_name(name, section, sub->name);
  }

  const SubObject* compare(const std::string& name, const PlainSection& section, ObjectKey key) {
    const auto* sub = dictionary_.find(key);
    ++compared_.subs;
    EXPECT_NE(sub, nullptr) << path_ << " [" << name << "] " << to_string(key);
    if (sub == nullptr) return nullptr;
    const auto code = plain_number(text_of(section, "datatype"), node.value());
    if (!code || code->bits > 0xFFFF) return sub;
    EXPECT_EQ(sub->type_code, code->bits) << path_ << " [" << name << "] DataType";
    const auto type = static_cast<DataType>(code->bits);
    if (!is_integer(type)) return sub;

    const Limits limits = limits_of(section, type);
    const auto value = [&](const char* what, const std::optional<Value>& got, unsigned& count) {
      const auto text = text_of(section, what);
      const auto number = plain_number(text, node.value());
      if (!number && !text.empty()) return;
      const auto expected = number && !limits.is_left_out(what) ? in_type(*number, type) : none;
      count += number.has_value();
      EXPECT_TRUE(got == expected || (!got && limits.may_be_left_out(what)))
          << path_ << " [" << name << "] " << to_string(key) << ' ' << what << '=' << text << " in "
          << takt::name(type);
    };
    value("defaultvalue", sub->default_value, compared_.defaults);
    value("parametervalue", sub->parameter_value, compared_.parameters);
    value("lowlimit", sub->low_limit, compared_.limits);
    value("highlimit", sub->high_limit, compared_.limits);
    return sub;
  }

  void compare_name(const std::string& name, const PlainSection& section, const std::string& got) {
    const auto expected = text_of(section, "parametername");
    if (expected.empty() || !is_ascii(expected)) return;
    ++compared_.names;
    EXPECT_EQ(got, expected) << path_ << " [" << name << ']';
  }

  std::filesystem::path path_;
  Compared& compared_;
  test::PlainIni ini_;
  ObjectDictionary dictionary_;
};

Compared judge(const std::vector<std::filesystem::path>& files) {
  Compared compared;
  for (const auto& path : files) Judge{path, compared}.run();
  std::printf(
      "%u files: %u sections, %u values' places, %u names, %u defaults, %u limits, %u set\n",
      compared.files, compared.objects, compared.subs, compared.names, compared.defaults,
      compared.limits, compared.parameters);
  return compared;
}

TEST(CorpusValues, OfOwnFilesAreThoseOfAPlainReader) {
  const auto compared = judge(test::device_files(test::own_eds_files()));

  EXPECT_GE(compared.files, 7U);
  EXPECT_GE(compared.defaults, 200U);
  EXPECT_GE(compared.limits, 20U);
}

TEST(CorpusValues, OfRealFilesAreThoseOfAPlainReader) {
  const auto files = test::device_files(test::eds_corpus() / "files");
  if (files.empty()) GTEST_SKIP() << "no corpus at " << test::eds_corpus();
  const auto compared = judge(files);

  EXPECT_GE(compared.defaults, 300 * compared.files / 2);
  EXPECT_GE(compared.limits, 50 * compared.files);
  EXPECT_GE(compared.parameters, 1000U);
}

}  // namespace
}  // namespace takt
