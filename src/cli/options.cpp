#include "cli/options.h"

#include <CLI/CLI.hpp>
#include <cmath>
#include <cstdint>
#include <cstdlib>
#include <optional>
#include <type_traits>
#include <utility>

#include "base/error.h"
#include "base/units.h"

namespace papilla::cli {
namespace {

// A command with its manual, which the parser has no place for.
struct DocumentedApp : CLI::App {
  DocumentedApp(const std::string& meaning, const std::string& name, CLI::App* parent)
      : CLI::App(meaning, name, parent) {}
  std::optional<Manual> manual;
};

std::string examples_text(const Manual& manual) {
  std::string out = manual.examples.empty() ? "" : "Examples:\n";
  for (const Manual::Line& line : manual.examples)
    out += "  " + line.what + "\n      " + line.meaning + "\n";
  return out;
}

}  // namespace

std::string share_mistake(const std::string& text) {
  if (const auto q = parse_quantity(text); q && q->unit.empty() && q->value >= 1)
    return text + " has no unit; write " + text + "%";
  try {
    const double share = parse_si(text, "%");
    if (share > 0 && share < 1) return "";
  } catch (const InputError& error) {
    return error.what();
  }
  return "expected more than 0 % and less than 100 %, got " + text;
}

void refuse(const std::vector<Option>& options, const std::string& whose) {
  for (const Option& option : options) {
    if (option.given()) throw InputError(option.name() + " is of " + whose);
  }
}

Option Option::required() const { return Option(option_->required()); }

Option Option::type_name(const std::string& name) const { return Option(option_->type_name(name)); }

Option Option::show_default() const { return Option(option_->capture_default_str()); }

Option Option::repeatable() const {
  return Option(option_->expected(1)->allow_extra_args(false)->multi_option_policy(
      CLI::MultiOptionPolicy::TakeAll));
}

Option Option::separator(char character) const { return Option(option_->delimiter(character)); }

Option Option::one_of(const std::vector<std::string>& values) const {
  return Option(option_->check(CLI::IsMember(values)));
}

Option Option::check(const std::function<std::string(const std::string&)>& mistake) const {
  return Option(option_->check(mistake));
}

template <typename T>
Option Option::range(T low, T high) const {
  option_->check(CLI::Range(low, high));
  if constexpr (std::is_floating_point_v<T>) {
    // NaN is neither below the range nor above it.
    option_->check([](const std::string& text) {
      return std::isnan(std::strtod(text.c_str(), nullptr)) ? "expected a number, got " + text
                                                            : std::string();
    });
  }
  return Option(option_);
}
template Option Option::range(int, int) const;
template Option Option::range(long, long) const;
template Option Option::range(double, double) const;

std::string Option::name() const { return option_->get_name(); }

bool Option::given() const { return option_->count() > 0; }

Command Command::add_command(const std::string& name, const std::string& meaning) const {
  return Command(app_->add_subcommand(std::make_shared<DocumentedApp>(meaning, name, app_)));
}

Command Command::document(Manual manual) const {
  auto& documented = dynamic_cast<DocumentedApp&>(*app_);
  documented.footer(examples_text(manual));
  documented.manual = std::move(manual);
  return *this;
}

const Manual& Command::manual() const {
  const auto* documented = dynamic_cast<const DocumentedApp*>(app_);
  if (!documented || !documented->manual) throw std::logic_error(name() + " has no manual");
  return *documented->manual;
}

template <typename T>
Option Command::add_option(const std::string& name, T& variable, const std::string& meaning) const {
  return Option(app_->add_option(name, variable, meaning));
}
using std::string, std::vector;
template Option Command::add_option(const string&, string&, const string&) const;
template Option Command::add_option(const string&, int&, const string&) const;
template Option Command::add_option(const string&, double&, const string&) const;
template Option Command::add_option(const string&, std::uint64_t&, const string&) const;
template Option Command::add_option(const string&, vector<string>&, const string&) const;
template Option Command::add_option(const string&, vector<double>&, const string&) const;

Option Command::add_flag(const std::string& name, bool& variable,
                         const std::string& meaning) const {
  return Option(app_->add_flag(name, variable, meaning));
}

Command Command::add_alternatives(const std::string& name) const {
  CLI::Option_group* group = app_->add_option_group(name);
  group->require_option(1);
  return Command(group);
}

void Command::require_command() const { app_->require_subcommand(1); }

void Command::on_chosen(const std::function<void()>& callback) const { app_->callback(callback); }

std::string Command::name() const { return app_->get_name(); }

std::vector<Command> Command::commands() const {
  std::vector<Command> all;
  for (CLI::App* app : app_->get_subcommands([](CLI::App*) { return true; })) {
    if (!app->get_name().empty()) all.emplace_back(app);
  }
  return all;
}

std::string Command::meaning() const { return app_->get_description(); }

std::vector<Command::OptionRow> Command::options() const {
  std::vector<OptionRow> rows;
  const auto add = [&rows](const CLI::App& app) {
    for (const CLI::Option* option : app.get_options()) {
      OptionRow row;
      for (const string& name : option->get_snames()) row.names.push_back("-" + name);
      for (const string& name : option->get_lnames()) row.names.push_back("--" + name);
      const bool flag = option->get_items_expected_max() == 0;
      row.value = row.names.empty() ? option->get_single_name()
                  : flag            ? ""
                                    : option->get_type_name();
      row.meaning = option->get_description();
      row.required = option->get_required();
      row.repeatable = option->get_items_expected_max() > 1;
      rows.push_back(std::move(row));
    }
  };
  add(*app_);
  // Groups of alternatives are commands without a name.
  for (const CLI::App* group : app_->get_subcommands([](CLI::App*) { return true; })) {
    if (group->get_name().empty()) add(*group);
  }
  return rows;
}

CommandLine::CommandLine(const std::string& name, const std::string& version,
                         const std::function<std::string()>& licences, const std::string& meaning)
    : app_(std::make_unique<CLI::App>(meaning, name)) {
  // Ends as --version does, and before it: together they print the libraries too.
  app_->add_flag_callback(
      "--licences", [licences] { throw CLI::CallForVersion(licences(), 0); },
      "Display the libraries of this build with their licences and exit");
  app_->set_version_flag("--version", version);
  app_->fallthrough();
  app_->require_subcommand(1);
}

CommandLine::~CommandLine() = default;

Command CommandLine::program() const { return Command(app_.get()); }

bool CommandLine::parse(int argc, const char* const* argv) const {
  try {
    app_->parse(argc, argv);
    return true;
  } catch (const CLI::Success& e) {  // --help, --version, --licences
    app_->exit(e);
    return false;
  } catch (const CLI::ParseError& e) {
    std::string commands;
    for (auto level = app_->get_subcommands(); !level.empty();
         level = level.front()->get_subcommands())
      commands += level.front()->get_name() + " ";
    throw CommandLineError(e.what(), commands);
  }
}

}  // namespace papilla::cli
