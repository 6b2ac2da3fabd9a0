#include "apps/takt/objects/chosen_object.hpp"

#include <algorithm>
#include <cctype>
#include <fmt/format.h>
#include <set>

#include "eds_parser/dictionary/object_names.hpp"
#include "eds_parser/report/suggest.hpp"

namespace takt {
namespace {

constexpr std::size_t most_listed = 8;

std::string device_text(const KnownDevice& device) {
  if (!device.name.empty()) return "node '" + device.name + "'";
  return device.id ? fmt::format("node {}", device.id->value()) : device.file;
}

/// Returns the reason why names of objects may be unknown: no device file, or one that can't be
/// read. Empty if the device file was read.
std::string sources_text(const KnownDevice& device) {
  if (device.dictionary) return {};
  if (device.file.empty()) {
    return " (only the names of its signals are known: name its device file with --eds FILE)";
  }
  return " (its device file " + device.file +
         " can't be read here, so only the names of its signals are known: name a copy with --eds "
         "FILE)";
}

Failure unknown(const KnownDevice& device, const std::string& word,
                const std::vector<std::string>& similar) {
  std::string guess;
  if (similar.size() == 1) guess = ", did you mean '" + similar.front() + "'?";
  for (std::size_t i = 0; similar.size() > 1 && i < similar.size(); ++i) {
    guess += (i == 0 ? "; similar names are: " : ", ") + similar[i];
  }
  return Failure{
      fmt::format("{} has no object '{}'{}{}{}", device_text(device), word, sources_text(device),
                  guess, similar.empty() && device.dictionary ? "; `takt od` lists them" : ""),
      exit_wrong_use};
}

Failure ambiguous(const std::string& word, const std::set<ObjectKey>& found,
                  const ObjectNames* names) {
  std::string list;
  std::size_t listed = 0;
  for (const ObjectKey key : found) {
    if (listed++ == most_listed) {
      list += fmt::format(" and {} more", found.size() - most_listed);
      break;
    }
    list += (list.empty() ? "" : ", ") + to_string(key);
    const std::string_view name = names == nullptr ? std::string_view{} : names->name_of(key);
    if (!name.empty()) list.append(" ").append(name);
  }
  return Failure{
      "'" + word + "' is the name of several objects; give the index of one of them: " + list,
      exit_wrong_use};
}

}  // namespace

std::string ChosenObject::text() const {
  return name.empty() ? to_string(key) : name + " (" + to_string(key) + ")";
}

bool is_object_name(std::string_view word) noexcept {
  return !word.empty() && std::isalpha(static_cast<unsigned char>(word.front())) != 0 &&
         word.find(':') == word.npos && !parse_object(word);
}

DataType type_of(const KnownDevice& device, ObjectKey key) noexcept {
  const SubObject* const sub = device.dictionary ? device.dictionary->find(key) : nullptr;
  if (sub != nullptr) return sub->type;
  const auto signal = std::ranges::find(device.signals, key, &KnownSignal::object);
  return signal == device.signals.end() ? DataType::unknown : signal->type;
}

ChosenObject find_object(const KnownDevice& device, const std::string& word) {
  std::optional<ObjectNames> names;
  if (device.dictionary) names.emplace(*device.dictionary);
  std::set<ObjectKey> found;
  for (const KnownSignal& signal : device.signals) {
    if (signal.name == snake_case(word)) found.insert(signal.object);
  }
  // A name of the image and of the device file may stand for different objects if only the second
  // axis of a drive is mapped.
  if (names) {
    const std::vector<ObjectKey> described = names->find(word);
    if (found.empty() || described.size() == 1) found.insert(described.begin(), described.end());
  }
  if (found.size() > 1) throw ambiguous(word, found, names ? &*names : nullptr);
  if (!found.empty()) return {*found.begin(), type_of(device, *found.begin()), word};
  if (names) throw unknown(device, word, names->similar(word));
  std::vector<std::string_view> candidates;
  for (const KnownSignal& signal : device.signals) candidates.push_back(signal.name);
  const std::string_view best = nearest(word, candidates);
  throw unknown(
      device, word,
      best.empty() ? std::vector<std::string>{} : std::vector<std::string>{std::string{best}});
}

}  // namespace takt
