#include "apps/command_line/known_words.hpp"

#include <algorithm>
#include <cstdio>
#include <span>
#include <string_view>
#include <utility>

#include "apps/command_line/completion.hpp"
#include "apps/command_line/help_text.hpp"
#include "apps/command_line/manual_page.hpp"
#include "eds_parser/report/suggest.hpp"

namespace takt {
namespace {

std::vector<std::string> commands_of(const CLI::App& app) {
  std::vector<std::string> names;
  for (const CLI::App* verb : app.get_subcommands({})) {
    if (!verb->get_group().empty()) names.push_back(verb->get_name());
  }
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

namespace {

/// Prints the help of a program or of one of its commands.
void print_help(const CLI::App& app, std::FILE* out) {
  std::string path;
  for (const CLI::App* at = app.get_parent(); at != nullptr; at = at->get_parent()) {
    path.insert(0, at->get_name() + (path.empty() ? "" : " "));
  }
  std::string options = app.help(path);
  const std::string notes = app.get_footer();
  if (options.ends_with(notes + '\n')) options.resize(options.size() - notes.size() - 1);
  const std::size_t column = app.get_formatter()->get_column_width();
  std::fputs(wrapped_help(options, column, notes, text_width()).c_str(), out);
}

/// Returns the command that the words name, or the last command before a word that names none.
const CLI::App& command_of(const CLI::App& app, std::span<const char* const> words) {
  const CLI::App* at = &app;
  for (const char* const word : words) {
    const auto verbs =
        at->get_subcommands([word](const CLI::App* verb) { return verb->check_name(word); });
    if (!verbs.empty()) at = verbs.front();
  }
  return *at;
}

/// Answers requests of a shell or of the build, and not of the user: `--complete WORD...` and
/// `--manual DIR`, which are no options of the help.
std::optional<int> answer_machine(const CLI::App& app, std::span<const char* const> arguments) {
  if (arguments.empty()) return std::nullopt;
  const std::string_view question = arguments.front();
  const auto rest = arguments.subspan(1);
  if (question == "--complete") {
    const std::vector<std::string> words{rest.begin(), rest.end()};
    std::fputs(completions(app, words).c_str(), stdout);
    return 0;
  }
  if (question != "--manual" || rest.size() != 1) return std::nullopt;
  return write_manual(app, rest.front()) ? 0 : 1;
}

}  // namespace

std::optional<int> parse_arguments(CLI::App& app, int argc, const char* const* argv) {
  const std::span arguments{argv + 1, argc > 0 ? static_cast<std::size_t>(argc - 1) : 0};
  if (const auto answered = answer_machine(app, arguments)) return answered;
  const bool asks = !arguments.empty() && std::string_view{arguments.front()} == "help" &&
                    !app.get_subcommands({}).empty();
  const std::string wrong =
      asks ? unknown_word(app, argc - 1, argv + 1) : unknown_word(app, argc, argv);
  if (!wrong.empty()) {
    std::fprintf(stderr, "%s\n", wrong.c_str());
    return 2;
  }
  const CLI::App& command = command_of(app, arguments);
  if (asks) {
    print_help(command, stdout);
    return 0;
  }
  try {
    app.parse(argc, argv);
  } catch (const CLI::CallForHelp&) {
    print_help(command, stdout);
    return 0;
  } catch (const CLI::ParseError& error) {
    const bool lacks_command = command.get_require_subcommand_min() > 0;
    if (lacks_command && error.get_exit_code() != 0) {
      print_help(command, stderr);
      return 2;
    }
    return app.exit(error) == 0 ? 0 : 2;
  }
  return std::nullopt;
}

}  // namespace takt
