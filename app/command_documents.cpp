#include "app/command_documents.h"

#include <algorithm>
#include <string_view>
#include <vector>

#include <fmt/format.h>
#include <CLI/CLI.hpp>

#include "core/version.h"

namespace rondure::app {
namespace {

/// A verb as typed ("run", "fit roundness"; empty: the program alone) with its options and
/// arguments.
struct VerbEntry {
  std::string words;
  const CLI::App* table;
};

std::vector<const CLI::App*> inner_verbs(const CLI::App& of) {
  return of.get_subcommands([](const CLI::App*) { return true; });
}

/// The program alone, its verbs, and their verbs.
std::vector<VerbEntry> all_verbs(const CLI::App& program) {
  std::vector<VerbEntry> out = {{"", &program}};
  for (const CLI::App* verb : inner_verbs(program)) {
    out.push_back({verb->get_name(), verb});
    for (const CLI::App* inner : inner_verbs(*verb)) {
      out.push_back({verb->get_name() + " " + inner->get_name(), inner});
    }
  }
  return out;
}

std::vector<const CLI::Option*> named_options(const CLI::App& verb) {
  return verb.get_options([](const CLI::Option* option) { return option->nonpositional(); });
}

std::vector<const CLI::Option*> positionals(const CLI::App& verb) {
  return verb.get_options([](const CLI::Option* option) { return option->get_positional(); });
}

bool takes_value(const CLI::Option& option) { return option.get_items_expected_max() > 0; }

/// "--out"; "-h" has a long name too.
std::string long_name(const CLI::Option& option) { return "--" + option.get_lnames().front(); }

/// The words that a value must be one of; empty: any value. CLI11 keeps them in the type:
/// "TEXT:{ls,mz}".
std::vector<std::string> listed_words(const CLI::Option& option) {
  const std::string type = option.get_type_name();
  const auto open = type.find('{');
  const auto close = type.find('}', open);
  if (close == std::string::npos) return {};
  return CLI::detail::split(type.substr(open + 1, close - open - 1), ',');
}

/// "DIR" from "DIR", "LIST" from "LIST:{html,pdf}".
std::string value_name(const CLI::Option& option) {
  const std::string type = option.get_type_name();
  return type.substr(0, type.find(':'));
}

/// Verbs and listed words that may be typed as a word without dashes.
std::vector<std::string> plain_words(const CLI::App& verb) {
  std::vector<std::string> out;
  for (const CLI::App* inner : inner_verbs(verb)) out.push_back(inner->get_name());
  for (const CLI::Option* option : positionals(verb)) {
    for (std::string& word : listed_words(*option)) out.push_back(std::move(word));
  }
  return out;
}

std::string one_line(std::string text) {
  std::replace(text.begin(), text.end(), '\n', ' ');
  return text;
}

/// Branches of a case statement that find the verb in the words typed so far: each pattern is a
/// verb and the next word.
std::string verb_branches(const std::vector<VerbEntry>& verbs) {
  std::string out;
  for (const VerbEntry& verb : verbs) {
    std::vector<std::string> patterns;
    for (const CLI::App* inner : inner_verbs(*verb.table)) {
      patterns.push_back(fmt::format("'{} {}'", verb.words, inner->get_name()));
    }
    if (patterns.empty()) continue;
    out += fmt::format("      {}) verb=\"{}\" ;;\n", fmt::join(patterns, " | "),
                       verb.words.empty() ? "$word" : "$verb $word");
  }
  return out;
}

/// A line of text in roff, escaped so that no part of it is a request.
std::string roff(std::string_view text) {
  std::string out;
  for (const char c : text) {
    const bool first = out.empty() || out.back() == '\n';
    if (first && (c == '.' || c == '\'')) out += "\\&";
    if (c == '\\') {
      out += "\\e";
    } else if (c == '-') {
      out += "\\-";
    } else {
      out += c;
    }
  }
  return out;
}

/// Text with its line breaks kept.
std::string roff_lines(std::string text) {
  while (!text.empty() && text.front() == '\n') text.erase(0, 1);
  return text.empty() ? "" : fmt::format(".PP\n.nf\n{}\n.fi\n", roff(text));
}

std::string synopsis(const VerbEntry& verb) {
  std::string out = "rondure " + verb.words;
  if (!named_options(*verb.table).empty()) out += " [OPTIONS]";
  for (const CLI::Option* option : positionals(*verb.table)) {
    const std::string name = option->get_name(true);
    out += option->get_required() ? " " + name : fmt::format(" [{}]", name);
  }
  return out;
}

std::string described(const CLI::Option& option) {
  const bool named = option.nonpositional();
  const std::string value = named && takes_value(option) ? value_name(option) : "";
  std::string out = fmt::format(".TP\n\\fB{}\\fR{}\n{}\n",
                                roff(named ? long_name(option) : option.get_name(true)),
                                value.empty() ? "" : fmt::format(" \\fI{}\\fR", roff(value)),
                                roff(one_line(option.get_description())));
  const std::vector<std::string> words = listed_words(option);
  if (!words.empty())
    out += fmt::format("One of {}.\n", roff(fmt::format("{}", fmt::join(words, ", "))));
  return out;
}

}  // namespace

std::string manual_page(const CLI::App& program) {
  std::string out = fmt::format(
      ".TH RONDURE 1 \"\" \"rondure {}\" \"User Commands\"\n"
      ".SH NAME\nrondure \\- cylindricity inspection with a CMM and a two\\-axis fixture\n"
      ".SH SYNOPSIS\n.B rondure\n.I VERB\n[\\fIOPTIONS\\fR] [\\fIARGUMENTS\\fR]\n"
      ".SH DESCRIPTION\n"
      "A plan in JSON says what to inspect. The program turns the fixture through poses, drives "
      "the\n"
      "probe of a real or simulated machine over layers of points, evaluates them, and writes a\n"
      "conformance report whose every digit can be recomputed from the recorded touches.\n"
      ".SH VERBS\n",
      core::kVersion);
  for (const VerbEntry& verb : all_verbs(program)) {
    if (verb.words.empty()) continue;
    out += fmt::format(".SS \"{}\"\n{}.\n", roff(synopsis(verb)),
                       roff(one_line(verb.table->get_description())));
    for (const CLI::Option* option : positionals(*verb.table)) out += described(*option);
    for (const CLI::Option* option : named_options(*verb.table)) {
      if (long_name(*option) != "--help") out += described(*option);
    }
    out += roff_lines(verb.table->get_footer());
  }
  out += ".SH EXIT STATUS\n" + roff_lines(program.get_footer());
  out +=
      ".SH FILES\n"
      ".TP\n.I /usr/share/rondure/plans/examples\nPlans to start from, each a lesson.\n"
      ".TP\n.I /usr/share/rondure/plans/schema/plan.schema.json\n"
      "The schema of a plan, for editors that complete and explain keys.\n"
      ".TP\n.I /usr/share/doc/rondure\nWhat every key, number and formula means.\n";
  return out;
}

std::string bash_completion(const CLI::App& program) {
  const std::vector<VerbEntry> verbs = all_verbs(program);
  std::string values, options, names;
  for (const VerbEntry& verb : verbs) {
    std::vector<std::string> words;
    for (const CLI::Option* option : named_options(*verb.table)) {
      words.push_back(long_name(*option));
      if (takes_value(*option)) {
        values += fmt::format("    '{} {}') words='{}' ;;\n", verb.words, words.back(),
                              fmt::join(listed_words(*option), " "));
      }
    }
    options += fmt::format("        '{}') words='{}' ;;\n", verb.words, fmt::join(words, " "));
    const std::vector<std::string> plain = plain_words(*verb.table);
    if (plain.empty()) continue;
    names += fmt::format("        '{}') words='{}' ;;\n", verb.words, fmt::join(plain, " "));
  }
  return fmt::format(
      "# Completion of rondure {} for bash: rondure completion bash\n"
      "_rondure() {{\n"
      "  local current=${{COMP_WORDS[COMP_CWORD]}} previous=${{COMP_WORDS[COMP_CWORD - 1]}}\n"
      "  local verb= word words=\n"
      "  for word in \"${{COMP_WORDS[@]:1:COMP_CWORD - 1}}\"; do\n"
      "    case \"$verb $word\" in\n"
      "{}"
      "    esac\n"
      "  done\n"
      "  case \"$verb $previous\" in\n"
      "{}"
      "    *)\n"
      "      if [[ $current == -* ]]; then\n"
      "        case \"$verb\" in\n{}        esac\n"
      "      else\n"
      "        case \"$verb\" in\n{}        esac\n"
      "      fi ;;\n"
      "  esac\n"
      "  COMPREPLY=($(compgen -W \"$words\" -- \"$current\"))\n"
      "}}\n"
      "complete -o default -F _rondure rondure\n",
      core::kVersion, verb_branches(verbs), values, options, names);
}

}  // namespace rondure::app
