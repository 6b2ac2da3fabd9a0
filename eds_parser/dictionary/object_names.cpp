#include "eds_parser/dictionary/object_names.hpp"

#include <algorithm>
#include <cctype>
#include <functional>
#include <iterator>
#include <utility>

#include "eds_parser/report/suggest.hpp"

namespace takt {
namespace {

constexpr std::size_t longest_name = 60;
constexpr std::size_t most_similar = 5;
constexpr std::uint16_t axis_step = 0x800;

/// Returns true if `key` is the object `first` of a further axis of the same drive.
bool is_of_further_axis(ObjectKey first, ObjectKey key) noexcept {
  return first.index >= 0x6000 && key.index < 0xA000 && first.sub == key.sub &&
         key.index > first.index && (key.index - first.index) % axis_step == 0;
}

/// Appends the number of the axis to names that only the axes of a drive share. `entries` are in
/// ascending order of their keys.
void number_axes(std::vector<ObjectNames::Entry>& entries) {
  std::map<std::string, std::vector<ObjectNames::Entry*>> same;
  for (ObjectNames::Entry& entry : entries) same[entry.name].push_back(&entry);
  for (const auto& [name, group] : same) {
    const ObjectKey first = group.front()->key;
    const bool axes = std::all_of(
        group.begin() + 1, group.end(),
        [&](const ObjectNames::Entry* entry) { return is_of_further_axis(first, entry->key); });
    if (!axes) continue;
    for (auto at = group.begin() + 1; at != group.end(); ++at) {
      (*at)->name += '_' + std::to_string(((*at)->key.index - first.index) / axis_step + 1);
    }
  }
}

std::multimap<std::string, ObjectKey, std::less<>> indexed(
    const std::vector<ObjectNames::Entry>& entries) {
  std::multimap<std::string, ObjectKey, std::less<>> index;
  for (const ObjectNames::Entry& entry : entries) index.emplace(entry.name, entry.key);
  return index;
}

/// Converts what a user types: `Identity object.Vendor-ID` becomes `identity_object.vendor_id`.
std::string normal(std::string_view word) {
  const std::size_t dot = word.find('.');
  if (dot == word.npos) return snake_case(word);
  return snake_case(word.substr(0, dot)) + '.' + snake_case(word.substr(dot + 1));
}

}  // namespace

std::string snake_case(std::string_view text) {
  std::string out;
  bool was_lower = false;
  for (const char c : text) {
    const auto byte = static_cast<unsigned char>(c);
    const bool word = byte < 0x80 && std::isalnum(byte) != 0;
    const bool word_begins = was_lower && std::isupper(byte) != 0;
    if ((!word || word_begins) && !out.empty() && out.back() != '_') out += '_';
    if (word) out += static_cast<char>(std::tolower(byte));
    was_lower = std::islower(byte) != 0;
    if (out.size() >= longest_name) break;
  }
  while (!out.empty() && out.back() == '_') out.pop_back();
  if (out.empty()) return "object";
  if (std::isdigit(static_cast<unsigned char>(out[0])) != 0) out.insert(0, "n");
  return out;
}

std::string object_name(const ObjectDictionary& dictionary, ObjectKey key) {
  const Object* object = dictionary.find(key.index);
  const SubObject* sub = dictionary.find(key);
  if (object == nullptr) return {};
  if (sub == nullptr || sub->name.empty() || object->type == ObjectType::var) return object->name;
  return sub->name;
}

ObjectNames::ObjectNames(const ObjectDictionary& dictionary) {
  std::vector<Entry> shorts;
  std::vector<Entry> records;
  for (const Object& object : dictionary.objects) {
    const bool record = object.type == ObjectType::array || object.type == ObjectType::record;
    const std::string of_object = snake_case(object.name);
    for (const SubObject& sub : object.subs) {
      const ObjectKey key{object.index, sub.sub};
      if (!record) {
        entries_.push_back({key, of_object});
        continue;
      }
      const std::string own = snake_case(object_name(dictionary, key));
      entries_.push_back({key, std::string{of_object}.append(1, '.').append(own)});
      shorts.push_back({key, own});
      records.push_back({{object.index, 0}, of_object});
    }
  }
  const auto same = [](const Entry& a, const Entry& b) { return a.key == b.key; };
  records.erase(std::unique(records.begin(), records.end(), same), records.end());
  for (std::vector<Entry>* entries : {&entries_, &shorts, &records}) number_axes(*entries);
  full_ = indexed(entries_);
  short_ = indexed(shorts);
  records_ = indexed(records);
}

std::vector<ObjectKey> ObjectNames::find(std::string_view word) const {
  const std::string name = normal(word);
  std::vector<ObjectKey> found;
  for (const Index* index : {&full_, &short_}) {
    const auto [first, last] = index->equal_range(name);
    for (auto at = first; at != last; ++at) found.push_back(at->second);
    std::ranges::sort(found);
    if (!found.empty()) return found;
  }
  const auto [first, last] = records_.equal_range(name);
  for (const Entry& entry : entries_) {
    const bool named = std::any_of(
        first, last, [&](const auto& record) { return record.second.index == entry.key.index; });
    if (named) found.push_back(entry.key);
  }
  return found;
}

std::string_view ObjectNames::name_of(ObjectKey key) const noexcept {
  const auto found = std::ranges::lower_bound(entries_, key, {}, &Entry::key);
  return found != entries_.end() && found->key == key ? std::string_view{found->name}
                                                      : std::string_view{};
}

std::vector<std::string> ObjectNames::similar(std::string_view word) const {
  const std::string name = normal(word);
  std::vector<std::string_view> candidates;
  for (const Index* index : {&full_, &short_}) {
    for (const auto& [candidate, key] : *index) candidates.push_back(candidate);
  }
  std::vector<std::string> found;
  if (const std::string_view best = nearest(name, candidates); !best.empty()) {
    found.emplace_back(best);
    return found;
  }
  for (const auto& [candidate, key] : full_) {
    if (found.size() == most_similar) break;
    if (candidate.find(name) != candidate.npos) found.push_back(candidate);
  }
  return found;
}

}  // namespace takt
