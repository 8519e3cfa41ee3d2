#include "validation/app/documents.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include "reference/base/text.hpp"

namespace plumbline::app {
namespace {

std::vector<const CLI::Option*> named_options(const CLI::App& app) {
  return app.get_options([](const CLI::Option* option) { return option->nonpositional(); });
}

std::vector<const CLI::Option*> positionals(const CLI::App& app) {
  return app.get_options([](const CLI::Option* option) { return option->get_positional(); });
}

// ---------------------------------------------------------------- man page

// A line that starts with a dot or an apostrophe would be a request; hyphens of options are minus signs.
std::string roff(std::string_view text) {
  std::string result = replaced(replaced(text, "\\", "\\e"), "-", "\\-");
  result = replaced(result, "\n.", "\n\\&.");
  result = replaced(result, "\n'", "\n\\&'");
  return result.starts_with('.') || result.starts_with('\'') ? "\\&" + result : result;
}

std::string entry(const CLI::Option& option) {
  const bool takes_value = option.get_items_expected_max() > 0 && option.nonpositional();
  const std::string name =
      option.get_positional() ? option.get_name(true, false) : option.get_name(false, true);
  return fmt::format(".TP\n.B {}{}\n{}\n", roff(name), takes_value ? " \\fIVALUE\\fR" : "",
                     roff(option.get_description()));
}

std::string section_of(const CLI::App& verb) {
  std::string text = fmt::format(".SS {}\n{}\n", roff(verb.get_name()), roff(verb.get_description()));
  for (const CLI::Option* option : positionals(verb)) text += entry(*option);
  for (const CLI::Option* option : named_options(verb)) text += entry(*option);
  if (!verb.get_footer().empty()) text += fmt::format(".PP\n{}\n", roff(verb.get_footer()));
  return text;
}

// ---------------------------------------------------------------- completion

std::string words_of(const CLI::App& app) {
  std::vector<std::string> words;
  for (const CLI::Option* option : named_options(app)) {
    for (const std::string& name : option->get_snames()) words.push_back("-" + name);
    for (const std::string& name : option->get_lnames()) words.push_back("--" + name);
  }
  return fmt::format("{}", fmt::join(words, " "));
}

}  // namespace

std::string man_page(const CLI::App& app) {
  std::string text = ".TH PLUMBLINE 1 \"\" \"plumbline " PLUMBLINE_VERSION "\"\n.SH NAME\nplumbline \\- " +
                     roff(app.get_description()) +
                     "\n.SH SYNOPSIS\n.B plumbline\n.I VERB\n[\\fIOPTION\\fR]...\n.SH VERBS\n";
  for (const CLI::App* verb : app.get_subcommands([](const CLI::App*) { return true; }))
    text += section_of(*verb);
  text += ".SH OPTIONS\n";
  for (const CLI::Option* option : named_options(app)) text += entry(*option);
  return text + fmt::format(".SH NOTES\n.nf\n{}\n.fi\n", roff(app.get_footer()));
}

std::string bash_completion(const CLI::App& app) {
  std::string verbs;
  std::string cases;
  for (const CLI::App* verb : app.get_subcommands([](const CLI::App*) { return true; })) {
    verbs += " " + verb->get_name();
    cases += fmt::format("    {}) words='{}' ;;\n", verb->get_name(), words_of(*verb));
  }
  return fmt::format(
      "# bash completion of the command plumbline\n"
      "_plumbline() {{\n"
      "  local words='{}{}'\n"
      "  case ${{COMP_WORDS[1]}} in\n{}  esac\n"
      "  if [ \"$COMP_CWORD\" -eq 1 ]; then words='{}{}'; fi\n"
      "  COMPREPLY=($(compgen -W \"$words\" -- \"${{COMP_WORDS[COMP_CWORD]}}\"))\n"
      "}}\n"
      "complete -o default -F _plumbline plumbline\n",
      words_of(app), verbs, cases, words_of(app), verbs);
}

}  // namespace plumbline::app
