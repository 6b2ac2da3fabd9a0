#pragma once
#include <concepts>
#include <cstdint>
#include <limits>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <type_traits>
#include <utility>
#include <vector>

#include "eds_parser/network_file/yaml/map_reader.hpp"
#include "eds_parser/table/firmware.hpp"
#include "eds_parser/values/time.hpp"

namespace takt {

// One row of a table describes one key of a YAML file. The same rows read the file and print its
// reference.

enum class KeyType : std::uint8_t {
  boolean,
  integer,
  number,
  text,
  word,
  version,   ///< "16.00.00"
  range,     ///< a whole number, or `[lowest, highest]`
  value,     ///< any scalar
  map,       ///< a map of `parts`
  list,      ///< a list of maps of `parts`; without `parts`, a list of values or words, or one word
  pair,      ///< a list of two numbers
  mapping,   ///< a list of objects: maps of `parts`, or the short form `0x6041:00`
  numbered,  ///< a map from numbers to maps of `parts`; without `parts`, to values
  group,     ///< no key, but `parts` that belong to the same map
  foreign,   ///< a key of other programs, which takt accepts with a note
};

enum class KeyOrigin : std::uint8_t {
  takt,
  bus_yml,  ///< also a key of the bus.yml of Lely's dcfgen or of ros2_canopen
};

struct KeyText;
using KeyRows = std::vector<KeyText>;

/// Limits of a number of the file.
struct RealRange {
  double low = -std::numeric_limits<double>::infinity();
  double high = std::numeric_limits<double>::infinity();
  bool without_low = false;  ///< `low` itself is not permitted

  constexpr bool contains(double number) const noexcept {
    return (without_low ? number > low : number >= low) && number <= high;
  }
};

/// The values that a key accepts.
struct KeyValue {
  KeyType type = KeyType::value;
  IntegerRange range{};    ///< range of an integer, or of the numbers of a map
  RealRange numbers{};     ///< range of a number
  IntegerRange entries{};  ///< range of each value, if the key is a list or a map of numbers
  std::span<const std::string_view> words{};  ///< accepted words; the key may also accept numbers
  KeyRows (*parts)() = nullptr;
};

/// The part of a row that the printed reference shows.
struct KeyText {
  /// Name of the key; for foreign keys, all their names with blanks between them.
  std::string_view name;
  KeyValue value{};
  std::string_view otherwise{};  ///< the default; empty if there is none
  std::string_view meaning{};
  KeyOrigin origin = KeyOrigin::takt;
  bool required = false;
};

struct KeyInput {
  MapReader& map;
  const KeyText& key;
  const YamlNode& node;

  NetworkReport& report() const noexcept { return map.report(); }
  /// Returns for example "`velocity` of `limits` of node `arm`".
  std::string what() const { return "`" + std::string{key.name} + "` of " + map.what(); }
  template <class... Parts>
  void error(std::string_view rule, const Parts&... parts) const {
    report().error(node.pos, rule, parts...);
  }
  /// Returns true if the value is a list of at most 1024 entries, or empty. Reports other values.
  bool is_list() const;
};

template <class T>
struct Key : KeyText {
  void (*read)(const KeyInput& in, T& target) = nullptr;
};

constexpr KeyValue whole(std::int64_t low, std::int64_t high, std::string_view unit = {}) {
  return {.type = KeyType::integer, .range = {low, high, unit}};
}
constexpr KeyValue number_within(RealRange numbers) {
  return {.type = KeyType::number, .numbers = numbers};
}
constexpr KeyValue number_above(double low) {
  return number_within({.low = low, .without_low = true});
}
constexpr KeyValue word_of(std::span<const std::string_view> words) {
  return {.type = KeyType::word, .words = words};
}
/// Makes a value that is a whole number, or one of the words.
constexpr KeyValue whole_or(std::span<const std::string_view> words, IntegerRange range) {
  return {.type = KeyType::integer, .range = range, .words = words};
}
/// Returns the rows of a table and of its groups.
template <const auto& Keys>
KeyRows rows_of() {
  KeyRows rows;
  for (const auto& key : Keys) {
    const KeyRows own = key.value.type == KeyType::group ? key.value.parts() : KeyRows{key};
    rows.insert(rows.end(), own.begin(), own.end());
  }
  return rows;
}

// Reads the value of a key into a variable of its type. The functions return false after an error,
// which they report. A type whose values have another form has an overload next to its table of
// keys.

bool read_value(const KeyInput& in, bool& out);
bool read_value(const KeyInput& in, double& out);
bool read_value(const KeyInput& in, std::string& out);
bool read_value(const KeyInput& in, Firmware& out);
/// Reads a number in the unit of the row.
bool read_value(const KeyInput& in, Time& out);

template <class From, class To>
bool store(const std::optional<From>& value, To& out) {
  if (value) out = static_cast<To>(*value);
  return value.has_value();
}

template <std::integral T>
bool read_value(const KeyInput& in, T& out) {
  return store(read_integer(in.node, in.key.name, in.key.value.range, in.report()), out);
}

/// Reads one of the words of a row. The words must be in the order of the enumerators of `T`.
template <class T>
  requires std::is_enum_v<T>
bool read_value(const KeyInput& in, T& out) {
  return store(read_choice(in.node, in.key.name, in.key.value.words, in.report()), out);
}

/// Returns true if the value is one of the words of a row that also accepts numbers. Any other word
/// is an error and sets `wrong`.
bool is_word(const KeyInput& in, bool& wrong);

/// Reads a number; a word of the row gives an empty value.
template <class T>
bool read_value(const KeyInput& in, std::optional<T>& out) {
  bool wrong = false;
  if (is_word(in, wrong)) return true;
  return !wrong && read_value(in, out.emplace());
}

template <class T>
void set(const KeyInput& in, T& out) {
  T value{};
  if (read_value(in, value)) out = std::move(value);
}
template <class T>
void set(const KeyInput& in, Sourced<T>& out) {
  T value{};
  if (read_value(in, value)) out = {std::move(value), in.node.pos, true};
}

template <class How>
struct KeyTarget;
template <class T, class Member>
struct KeyTarget<Member T::*> {
  using Type = T;
  using Value = Member;
};
template <class T>
struct KeyTarget<void (*)(const KeyInput&, T&)> {
  using Type = T;
  using Value = void;
};

template <class T>
struct Written {
  using Type = T;
};
template <class T>
struct Written<Sourced<T>> : Written<T> {};
template <class T>
struct Written<std::optional<T>> : Written<T> {};

/// Returns `value` with the type and the range that follow from the type `T` of the variable,
/// unless the row states them.
template <class T>
constexpr KeyValue completed(KeyValue value) {
  if (value.type != KeyType::value && value.type != KeyType::integer) return value;
  if constexpr (std::is_same_v<T, bool>) {
    value.type = KeyType::boolean;
  } else if constexpr (std::integral<T>) {
    value.type = KeyType::integer;
    if (value.range == IntegerRange{}) {
      value.range.high = static_cast<std::int64_t>(std::numeric_limits<T>::max());
    }
  } else if constexpr (std::floating_point<T>) {
    value.type = KeyType::number;
  } else if constexpr (std::is_same_v<T, std::string>) {
    value.type = KeyType::text;
  } else if constexpr (std::is_same_v<T, Firmware>) {
    value.type = KeyType::version;
  }
  return value;
}

template <auto First, auto... Rest>
constexpr auto& member_of(auto& object) noexcept {
  if constexpr (sizeof...(Rest) == 0) {
    return object.*First;
  } else {
    return member_of<Rest...>(object.*First);
  }
}

/// Makes a row whose value goes to the member `First`, or with `Rest` to a member of that member.
/// `First` may also be a function `void (const KeyInput&, T&)` that reads the value.
template <auto First, auto... Rest>
constexpr auto key(std::string_view name, KeyValue value, std::string_view otherwise,
                   std::string_view meaning, KeyOrigin origin = KeyOrigin::takt) {
  using Target = KeyTarget<decltype(First)>;
  using T = typename Target::Type;
  Key<T> row{{name, value, otherwise, meaning, origin}};
  if constexpr (std::is_member_object_pointer_v<decltype(First)>) {
    using Member = std::remove_reference_t<decltype(member_of<First, Rest...>(std::declval<T&>()))>;
    row.value = completed<typename Written<Member>::Type>(value);
    row.read = [](const KeyInput& in, T& target) { set(in, member_of<First, Rest...>(target)); };
  } else {
    row.read = First;
  }
  return row;
}
template <auto First, auto... Rest>
constexpr auto key(std::string_view name, std::string_view otherwise, std::string_view meaning,
                   KeyOrigin origin = KeyOrigin::takt) {
  return key<First, Rest...>(name, KeyValue{}, otherwise, meaning, origin);
}

template <class T>
constexpr Key<T> required(Key<T> row) {
  row.required = true;
  row.otherwise = "required";
  return row;
}
/// Makes a row for keys of other programs, which takt accepts. `why` states why they have no
/// effect.
template <class T>
constexpr Key<T> foreign(std::string_view names, std::string_view why) {
  return {{names, {.type = KeyType::foreign}, {}, why, KeyOrigin::bus_yml}};
}

/// Reports that a required key is missing at `pos`.
void report_missing(MapReader& map, const KeyText& key, SourcePos pos);

/// Reads the keys of one map. Missing keys are reported at `pos`.
template <class T, std::size_t N>
void read_keys(MapReader& map, const Key<T> (&keys)[N], T& out, SourcePos pos) {
  for (const Key<T>& key : keys) {
    if (key.value.type == KeyType::foreign) {
      map.ignore(key.name, key.meaning);
    } else if (key.value.type == KeyType::group) {
      key.read({map, key, map.node()}, out);
    } else if (const YamlNode* node = map.take(key.name); node != nullptr && key.read != nullptr) {
      key.read({map, key, *node}, out);
    }
  }
  for (const Key<T>& key : keys) {
    if (key.required) report_missing(map, key, pos);
  }
}

/// Reads a map with these keys and no others.
template <class T, std::size_t N>
void read_map(const YamlNode& node, std::string what, const Key<T> (&keys)[N], T& out,
              NetworkReport& report) {
  MapReader map{node, std::move(what), report};
  if constexpr (requires { out.pos = node.pos; }) out.pos = node.pos;
  if constexpr (requires { out.fact.pos = node.pos; }) out.fact.pos = node.pos;
  read_keys(map, keys, out, node.pos);
  map.finish();
}

/// Makes a row for the keys of a member that are written in the same map.
template <auto Member, const auto& Keys>
constexpr auto group() {
  using T = typename KeyTarget<decltype(Member)>::Type;
  Key<T> row{{{}, {.type = KeyType::group, .parts = rows_of<Keys>}}};
  row.read = [](const KeyInput& in, T& target) {
    read_keys(in.map, Keys, target.*Member, in.node.pos);
  };
  return row;
}

/// Makes a row that adds the keys of the table `Keys` to the same map.
template <class T, const auto& Keys>
constexpr Key<T> also() {
  Key<T> row{{{}, {.type = KeyType::group, .parts = rows_of<Keys>}}};
  row.read = [](const KeyInput& in, T& target) { read_keys(in.map, Keys, target, in.node.pos); };
  return row;
}

/// Makes a row whose value is a map of `Keys`. `Check` may check the map as a whole.
template <auto Member, const auto& Keys, auto Check = nullptr>
constexpr auto map_key(std::string_view name, std::string_view otherwise, std::string_view meaning,
                       KeyOrigin origin = KeyOrigin::takt) {
  using T = typename KeyTarget<decltype(Member)>::Type;
  Key<T> row{{name, {.type = KeyType::map, .parts = rows_of<Keys>}, otherwise, meaning, origin}};
  row.read = [](const KeyInput& in, T& target) {
    typename Written<typename KeyTarget<decltype(Member)>::Value>::Type part{};
    read_map(in.node, in.what(), Keys, part, in.report());
    if constexpr (!std::is_null_pointer_v<decltype(Check)>) Check(in, part);
    target.*Member = std::move(part);
  };
  return row;
}

/// Reads a list of maps of `Keys` and appends the entries without errors to `out`. `Check` compares
/// an entry without errors with the entries before it, and reports errors.
template <const auto& Keys, auto Check = nullptr, class T>
void read_list(const KeyInput& in, std::vector<T>& out) {
  if (!in.is_list()) return;
  for (const YamlNode* item : in.node.items) {
    const std::size_t errors = in.report().errors();
    T entry{};
    read_map(*item, "an entry of " + in.what(), Keys, entry, in.report());
    if constexpr (!std::is_null_pointer_v<decltype(Check)>) {
      if (in.report().errors() == errors) Check(KeyInput{in.map, in.key, *item}, out, entry);
    }
    if (in.report().errors() == errors) out.push_back(std::move(entry));
  }
}

/// Makes a row whose value is a list of maps of `Keys`.
template <auto Member, const auto& Keys, auto Check = nullptr>
constexpr auto list_key(std::string_view name, std::string_view otherwise, std::string_view meaning,
                        KeyOrigin origin = KeyOrigin::takt) {
  using T = typename KeyTarget<decltype(Member)>::Type;
  Key<T> row{{name, {.type = KeyType::list, .parts = rows_of<Keys>}, otherwise, meaning, origin}};
  row.read = [](const KeyInput& in, T& target) { read_list<Keys, Check>(in, target.*Member); };
  return row;
}

}  // namespace takt
