#include "apps/command_line/manual_page.hpp"

#include <algorithm>
#include <cctype>
#include <fstream>
#include <sstream>
#include <string_view>
#include <vector>

namespace takt {
namespace {

std::string escaped(std::string_view text) {
  std::string out;
  for (const char c : text) {
    if (c == '\\') {
      out += "\\e";
    } else if (c == '-') {
      out += "\\-";
    } else if (c == '\n') {
      out += ' ';
    } else {
      out += c;
    }
  }
  return out.starts_with('.') || out.starts_with('\'') ? "\\&" + out : out;
}

std::string bold(std::string_view text) { return "\\fB" + escaped(text) + "\\fR"; }
std::string italic(std::string_view text) { return "\\fI" + escaped(text) + "\\fR"; }

/// Returns prose with the words in backticks bold.
std::string prose(std::string_view text) {
  std::string out;
  while (!text.empty()) {
    const std::size_t open = text.find('`');
    const std::size_t close = open == text.npos ? open : text.find('`', open + 1);
    if (close == text.npos) break;
    out += escaped(text.substr(0, open)) + bold(text.substr(open + 1, close - open - 1));
    text.remove_prefix(close + 1);
  }
  return out + escaped(text);
}

std::string dashed(std::string path) {
  std::ranges::replace(path, ' ', '-');
  return path;
}

/// Returns the section of the manual. The taktd daemon is a program for administrators.
std::string section_of(const std::string& path) { return path == "taktd" ? "8" : "1"; }

/// The notes below the options, which --help prints as they are.
struct Notes {
  std::string text;
  std::string examples;
  std::string exit_codes;
};

Notes notes_of(const std::string& footer) {
  Notes notes;
  std::istringstream lines{footer};
  std::string* at = &notes.text;
  bool in_examples = false;
  for (std::string line; std::getline(lines, line);) {
    const bool heading = line == "Example:" || line == "Examples:";
    if (line.empty() || heading) {
      in_examples = heading;
      at = &notes.text;
      if (!notes.text.empty() && !heading) notes.text += ".PP\n";
    } else if (line.starts_with("Example:")) {
      notes.examples += escaped(line.substr(line.find_first_not_of(' ', 8))) + '\n';
    } else if (line.starts_with(' ') && in_examples) {
      notes.examples += escaped(line.substr(line.find_first_not_of(' '))) + '\n';
    } else if (line.starts_with(' ')) {
      *at += ".br\n" + prose(line.substr(line.find_first_not_of(' '))) + '\n';
    } else {
      in_examples = false;
      if (line.starts_with("Exit codes")) at = &notes.exit_codes;
      *at += prose(line) + '\n';
    }
  }
  while (notes.text.ends_with(".PP\n")) notes.text.resize(notes.text.size() - 4);
  return notes;
}

bool is_shown(const CLI::Option* option) { return !option->get_group().empty(); }

bool is_list(const CLI::Option& option) {
  return option.get_expected_max() >= CLI::detail::expected_max_vector_size;
}

std::string sentence_of(std::string_view description) {
  return prose(description) + (description.ends_with('.') ? "\n" : ".\n");
}

std::string name_of(const CLI::Option& option) {
  if (option.get_positional()) return italic(option.get_name(true));
  std::string names;
  const auto add = [&names](const std::string& name) {
    names += (names.empty() ? "" : ", ") + bold(name);
  };
  for (const std::string& name : option.get_snames()) add("-" + name);
  for (const std::string& name : option.get_lnames()) add("--" + name);
  if (option.get_type_size() != 0) names += ' ' + italic(option.get_type_name());
  return names;
}

std::string option_entry(const CLI::Option& option) {
  std::string facts;
  const auto add = [&facts](const std::string& fact) {
    facts += (facts.empty() ? "" : "; ") + fact;
  };
  if (option.get_required()) add("required");
  if (is_list(option)) add("may be repeated");
  if (!option.get_default_str().empty()) add("default: " + bold(option.get_default_str()));
  if (!option.get_envname().empty()) add("environment: " + bold(option.get_envname()));
  for (const CLI::Option* other : option.get_excludes()) add("not with " + bold(other->get_name()));
  return ".TP\n" + name_of(option) + '\n' + prose(option.get_description()) +
         (facts.empty() ? "" : " (" + facts + ')') + '\n';
}

std::string synopsis(const CLI::App& app, const std::string& path) {
  std::string text = bold(path) + " [" + italic("OPTIONS") + ']';
  for (const CLI::Option* option : app.get_options()) {
    if (!option->get_positional() || !is_shown(option)) continue;
    const std::string name = italic(option->get_name(true)) + (is_list(*option) ? " ..." : "");
    text += ' ' + (option->get_required() ? name : '[' + name + ']');
  }
  if (!app.get_subcommands({}).empty()) text += ' ' + italic("COMMAND") + " ...";
  return text + '\n';
}

std::string options(const CLI::App& app) {
  std::string text;
  for (const bool positional : {true, false}) {
    for (const CLI::Option* option : app.get_options()) {
      if (is_shown(option) && option->get_positional() == positional) text += option_entry(*option);
    }
  }
  return text;
}

/// Returns the commands of a program by groups, each with its page.
std::string commands(const CLI::App& app, const std::string& path) {
  std::string text;
  std::string group;
  for (const CLI::App* verb : app.get_subcommands({})) {
    if (verb->get_group().empty()) continue;
    if (verb->get_group() != group) text += ".SS " + escaped(group = verb->get_group()) + '\n';
    text += ".TP\n" + bold(dashed(path + ' ' + verb->get_name())) + "(1)\n" +
            prose(verb->get_description()) + '\n';
  }
  return text;
}

/// Returns the commands of a command, each with its options.
std::string inner_commands(const CLI::App& app, const std::string& path) {
  std::string text;
  for (const CLI::App* verb : app.get_subcommands({})) {
    const std::string own = path + ' ' + verb->get_name();
    text += ".SS " + escaped(own) + '\n' + sentence_of(verb->get_description()) + ".PP\n" +
            synopsis(*verb, own) + options(*verb);
    const Notes notes = notes_of(verb->get_footer());
    if (!notes.text.empty() && verb->get_footer() != app.get_footer()) text += ".PP\n" + notes.text;
  }
  return text;
}

void add_part(std::string& page, const char* heading, const std::string& text) {
  if (!text.empty()) page += std::string{".SH "} + heading + '\n' + text;
}

/// Returns a description without the name of the program, in the form of the section NAME.
std::string summary(const CLI::App& app) {
  std::string text = app.get_description();
  const std::string name = app.get_name() + " - ";
  if (text.starts_with(name)) text.erase(0, name.size());
  text.resize(std::min(text.find(". "), text.size()));
  if (text.ends_with('.')) text.pop_back();
  return escaped(text);
}

}  // namespace

std::string manual_page(const CLI::App& app, const std::string& path) {
  const CLI::App* parent = app.get_parent();
  std::string title = dashed(path);
  std::ranges::transform(title, title.begin(), [](unsigned char c) { return std::toupper(c); });
  const Notes notes = notes_of(app.get_footer());
  const bool is_tool = parent == nullptr && !app.get_subcommands({}).empty();
  std::string page = ".TH " + escaped(title) + ' ' + section_of(path) + " \"\" \"takt\" \"takt\"\n";
  add_part(page, "NAME", escaped(dashed(path)) + " \\- " + summary(app) + '\n');
  add_part(page, "SYNOPSIS", synopsis(app, path));
  add_part(page, "DESCRIPTION",
           sentence_of(app.get_description()) + (notes.text.empty() ? "" : ".PP\n" + notes.text));
  add_part(page, "OPTIONS", options(app));
  add_part(page, "COMMANDS", is_tool ? commands(app, path) : inner_commands(app, path));
  add_part(page, "EXIT STATUS", notes.exit_codes);
  if (!notes.examples.empty()) add_part(page, "EXAMPLES", ".EX\n" + notes.examples + ".EE\n");
  add_part(
      page, "SEE ALSO",
      parent == nullptr ? "/usr/share/doc/takt/index.md\n" : bold(parent->get_name()) + "(1)\n");
  return page;
}

bool write_manual(const CLI::App& app, const std::filesystem::path& folder) {
  const auto write = [&folder](const CLI::App& program, const std::string& path) {
    std::ofstream file{folder / (dashed(path) + '.' + section_of(path))};
    file << manual_page(program, path);
    return file.flush().good();
  };
  bool good = write(app, app.get_name());
  for (const CLI::App* verb : app.get_subcommands({})) {
    if (!verb->get_group().empty())
      good = write(*verb, app.get_name() + ' ' + verb->get_name()) && good;
  }
  return good;
}

}  // namespace takt
