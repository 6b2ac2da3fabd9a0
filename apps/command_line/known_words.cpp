#include "apps/command_line/known_words.hpp"

#include <algorithm>
#include <cstdio>
#include <string_view>
#include <utility>

#include "eds_parser/report/suggest.hpp"

namespace takt {
namespace {

std::vector<std::string> commands_of(const CLI::App& app) {
  std::vector<std::string> names;
  for (const CLI::App* verb : app.get_subcommands({})) names.push_back(verb->get_name());
  return names;
}

std::vector<std::string> options_of(const CLI::App& app) {
  std::vector<std::string> names;
  for (const CLI::Option* option : app.get_options()) {
    for (const std::string& name : option->get_lnames()) names.push_back("--" + name);
  }
  return names;
}

std::string unknown_command(const std::string& path, const CLI::App& app, const std::string& word) {
  const std::vector<std::string> names = commands_of(app);
  std::string list;
  for (const std::string& name : names) list += ' ' + name;
  return path + ": no command '" + word + "'" + guess(word, names) + "; there are:" + list;
}

std::string unknown_option(const std::string& path, const CLI::App& app, const std::string& word) {
  const std::string name = word.substr(0, word.find('='));
  const std::vector<std::string> names = options_of(app);
  if (std::ranges::find(names, name) != names.end()) return {};
  return path + ": no option '" + name + "'" + guess(name, names) + "; " + path +
         " --help lists the options";
}

}  // namespace

std::string guess(const std::string& word, const std::vector<std::string>& names) {
  const std::vector<std::string_view> candidates{names.begin(), names.end()};
  const std::string_view best = nearest(word, candidates);
  return best.empty() ? "" : ", did you mean '" + std::string{best} + "'?";
}

CLI::Validator one_of(std::vector<std::string> words) {
  std::string list;
  for (const std::string& word : words) list += (list.empty() ? "" : ", ") + word;
  const std::string described = "{" + list + "}";
  const auto check = [words = std::move(words), list = std::move(list)](const std::string& word) {
    if (std::ranges::find(words, word) != words.end()) return std::string{};
    const std::string guessed = guess(word, words);
    return "'" + word + "' is not one of " + list + guessed;
  };
  return CLI::Validator{check, described};
}

std::string unknown_word(const CLI::App& app, int argc, const char* const* argv) {
  const CLI::App* at = &app;
  std::string path = app.get_name();
  for (int i = 1; i < argc; ++i) {
    const std::string word = argv[i];
    if (word == "--") return {};
    if (word.starts_with("--")) {
      std::string wrong = unknown_option(path, *at, word);
      if (!wrong.empty()) return wrong;
    }
    if (word.starts_with('-') || at->get_subcommands({}).empty()) continue;
    const auto verbs =
        at->get_subcommands([&word](const CLI::App* verb) { return verb->check_name(word); });
    if (verbs.empty()) return unknown_command(path, *at, word);
    path += ' ' + word;
    at = verbs.front();
  }
  return {};
}

std::optional<int> parse_arguments(CLI::App& app, int argc, const char* const* argv) {
  if (const std::string wrong = unknown_word(app, argc, argv); !wrong.empty()) {
    std::fprintf(stderr, "%s\n", wrong.c_str());
    return 2;
  }
  try {
    app.parse(argc, argv);
  } catch (const CLI::ParseError& error) {
    return app.exit(error) == 0 ? 0 : 2;
  }
  return std::nullopt;
}

}  // namespace takt
