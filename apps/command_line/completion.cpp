#include "apps/command_line/completion.hpp"

#include <algorithm>
#include <string_view>
#include <utility>
#include <vector>

namespace takt {
namespace {

/// The kind of a value, by the name of an option or of a place on the command line.
struct ValueKind {
  std::string_view name;
  std::string_view answer;
};

constexpr ValueKind value_kinds[] = {
    {"NET", ":files yaml yml"},
    {"NET.yaml", ":files yaml yml"},
    {"--network", ":files yaml yml"},
    {"--diff", ":files yaml yml"},
    {"--faults", ":files yaml yml"},
    {"rules", ":files yaml yml"},
    {"--eds", ":files eds dcf"},
    {"FILE.svg", ":files svg"},
    {"DIR", ":directories"},
    {"FILE", ":files"},
    {"FILE|live", ":files"},
    {"LOG", ":files"},
    {"files", ":files"},
    {"--candump", ":files"},
    {"-o", ":files"},
    {"NODE", ":ask nodes"},
    {"SIGNAL", ":ask signals"},
    {"--node", ":ask nodes"},
    {"OBJ", ":ask objects"},
    {"IFACE", ":ask interfaces"},
    {"bus", ":ask buses"},
    {"BUS", ":ask buses"},
    {"--bus-name", ":ask buses"},
    {"axes", ":ask nodes"},
    {"--axis", ":ask nodes"},
    {"--leader", ":ask nodes"},
};

std::string first_line(std::string text) {
  text.resize(std::min(text.find('\n'), text.size()));
  return text;
}

bool takes_value(const CLI::Option& option) { return option.get_type_size() != 0; }

/// The position of the last word on a command line.
struct Place {
  const CLI::App* at;
  const CLI::Option* option = nullptr;  ///< option whose value the last word is
  std::size_t positional = 0;
  std::string network;              ///< the network file on the line
  std::vector<std::string> values;  ///< words that are no options and no commands
};

const CLI::App* command_named(const CLI::App& app, const std::string& word) {
  const auto found = app.get_subcommands([&word](const CLI::App* verb) {
    return verb->check_name(word) && !verb->get_group().empty();
  });
  return found.empty() ? nullptr : found.front();
}

const CLI::Option* option_named(const CLI::App& app, const std::string& word) {
  const auto found = app.get_options([&word](const CLI::Option* option) {
    return option->nonpositional() && option->check_name(word);
  });
  return found.empty() ? nullptr : found.front();
}

Place place_of(const CLI::App& app, std::span<const std::string> before) {
  Place place{&app, nullptr, 0, {}, {}};
  for (const std::string& word : before) {
    if (place.option != nullptr) {
      place.option = nullptr;
    } else if (word.starts_with('-') && word.size() > 1) {
      const CLI::Option* option = option_named(*place.at, word);
      if (option != nullptr && takes_value(*option)) place.option = option;
    } else if (const CLI::App* verb = command_named(*place.at, word)) {
      place.at = verb;
    } else if (word != "help") {
      ++place.positional;
      place.values.push_back(word);
      if (word.ends_with(".yaml") || word.ends_with(".yml")) place.network = word;
    }
  }
  return place;
}

class Proposals {
 public:
  explicit Proposals(const std::string& begin) : begin_{begin} {}

  void add(const std::string& word, const std::string& meaning = {}) {
    if (word.starts_with(begin_)) text_ += word + '\t' + first_line(meaning) + '\n';
  }
  void add_values(const CLI::Option& option, const Place& place) {
    const std::string type = option.get_type_name();  // "MODE:{enforce, try, off}"
    if (const std::size_t open = type.find('{'); open != type.npos) {
      add_words(type.substr(open + 1, type.find('}', open) - open - 1));
      return;
    }
    const std::string kind = type.substr(0, type.find(':'));
    const auto is_kind = [&](const ValueKind& known) {
      return known.name == kind || known.name == option.get_name(option.get_positional()) ||
             option.check_name(std::string{known.name});
    };
    const auto found = std::ranges::find_if(value_kinds, is_kind);
    if (found == std::end(value_kinds)) return;
    text_ += found->answer;
    if (found->answer.starts_with(":ask")) {
      if (!place.network.empty()) text_ += " --network " + place.network;
      if (found->answer == ":ask objects" && !place.values.empty()) {
        text_ += " --node " + place.values.back();
      }
    }
    text_ += '\n';
  }
  std::string take() { return std::move(text_); }

 private:
  void add_words(std::string_view list) {
    while (!list.empty()) {
      const std::string_view word = list.substr(0, list.find(", "));
      add(std::string{word});
      list.remove_prefix(std::min(word.size() + 2, list.size()));
    }
  }

  const std::string& begin_;
  std::string text_;
};

void add_options(const CLI::App& app, Proposals& out) {
  for (const CLI::Option* option : app.get_options()) {
    if (option->get_group().empty()) continue;
    for (const std::string& name : option->get_lnames())
      out.add("--" + name, option->get_description());
    if (option->get_lnames().empty()) {
      for (const std::string& name : option->get_snames())
        out.add("-" + name, option->get_description());
    }
  }
}

void add_positional(const Place& place, Proposals& out) {
  const auto positionals =
      place.at->get_options([](const CLI::Option* option) { return option->get_positional(); });
  if (positionals.empty()) return;
  const std::size_t last = positionals.size() - 1;
  if (place.positional > last &&
      positionals[last]->get_expected_max() < CLI::detail::expected_max_vector_size) {
    return;
  }
  out.add_values(*positionals[std::min(place.positional, last)], place);
}

}  // namespace

std::string completions(const CLI::App& app, std::span<const std::string> words) {
  if (words.empty()) return {};
  const Place place = place_of(app, words.first(words.size() - 1));
  Proposals out{words.back()};
  if (place.option != nullptr) {
    out.add_values(*place.option, place);
  } else if (words.back().starts_with('-')) {
    add_options(*place.at, out);
  } else {
    for (const CLI::App* verb : place.at->get_subcommands({})) {
      if (!verb->get_group().empty()) out.add(verb->get_name(), verb->get_description());
    }
    if (place.at == &app && !app.get_subcommands({}).empty())
      out.add("help", "prints the help of a command");
    add_positional(place, out);
  }
  return out.take();
}

}  // namespace takt
