#include "tools/manual_page.hpp"

#include <fmt/format.h>

#include <CLI/CLI.hpp>
#include <memory>
#include <string_view>

#include "tools/cli_style.hpp"

namespace forager::tools {
namespace {

// Text as it shall be read: a hyphen that is a minus, no line taken for a command of the formatter's.
std::string roff(std::string_view text) {
  std::string out;
  if (text.starts_with('.') || text.starts_with('\'')) out += "\\&";
  for (const char c : text) {
    if (c == '\\')
      out += "\\e";
    else if (c == '-')
      out += "\\-";
    else
      out += c;
  }
  return out;
}

std::string full_name(const CLI::App& app) {
  return app.get_parent() == nullptr ? app.get_name() : full_name(*app.get_parent()) + " " + app.get_name();
}

bool takes_value(const CLI::Option& option) { return option.get_items_expected_max() > 0; }

std::string value_of(const CLI::Option& option) {
  return takes_value(option) ? fmt::format(" \\fI{}\\fR", roff(option.get_type_name())) : std::string();
}

void add_option_entry(std::string& page, const CLI::Option& option) {
  page += ".TP\n";
  if (option.get_positional()) {
    page += fmt::format("\\fI{}\\fR{}\n", roff(option.get_name(true)),
                        option.get_required() ? "" : " (optional)");
  } else {
    std::string names;
    for (const std::string& name : option.get_snames())
      names += fmt::format("{}\\fB\\-{}\\fR", names.empty() ? "" : ", ", roff(name));
    for (const std::string& name : option.get_lnames())
      names += fmt::format("{}\\fB\\-\\-{}\\fR", names.empty() ? "" : ", ", roff(name));
    page += names + value_of(option) + (option.get_required() ? " (required)" : "") + "\n";
  }
  page += roff(option.get_description());
  if (!option.get_default_str().empty()) page += fmt::format(" [{}]", roff(option.get_default_str()));
  page += "\n";
}

std::string usage_of(const CLI::App& app) {
  std::string usage = fmt::format("\\fB{}\\fR", roff(full_name(app)));
  for (const CLI::Option* option : app.get_options()) {
    if (!option->get_positional()) continue;
    const std::string name = fmt::format("\\fI{}\\fR", roff(option->get_name(true)));
    usage += option->get_required() ? " " + name : " [" + name + "]";
  }
  return usage + " [\\fIoptions\\fR]";
}

// The commands that do something, in the order of the help; a group is only its members.
void add_commands(std::string& page, const CLI::App& app) {
  const auto inner = app.get_subcommands([](const CLI::App*) { return true; });
  for (const CLI::App* command : inner) {
    if (command->get_group().empty()) continue;
    if (!command->get_subcommands([](const CLI::App*) { return true; }).empty()) {
      add_commands(page, *command);
      continue;
    }
    page += fmt::format(".SS {}\n{}.\n.PP\n{}\n", roff(full_name(*command)), roff(command->get_description()),
                        usage_of(*command));
    for (const CLI::Option* option : command->get_options())
      if (option != command->get_help_ptr()) add_option_entry(page, *option);
  }
}

constexpr std::string_view kRest = R"(.SH EXIT STATUS
.TP
.B 0
done
.TP
.B 1
a device or input and output failed
.TP
.B 2
asked wrongly: unknown option, wrong value, mistake in a file
.TP
.B 3
not built in, not present, no permission; the message says which package, path or group
.TP
.B 4
ran to its end, and a check failed
.PP
Results go to standard output, everything else to standard error.
.SH FILES
Scenes and boards are TOML files; every key stands in
.IR docs/boards.md .
.SH ENVIRONMENT
A board file names the variable that holds a reader's password
.RI ( reader.password_env );
there is no place for a password in a file.
.SH EXAMPLES
.nf
forager run scenes/4A.toml \-\-output out/4A
forager report out/4A
forager reader watch \-\-host 192.168.1.50 \-\-for 10s
forager mavlink listen \-\-serial /dev/ttyAMA0 \-\-baud 57600
.fi
)";

}  // namespace

std::string manual_page(const CLI::App& app, const std::string& version) {
  std::string page = fmt::format(
      ".TH FORAGER 1 \"\" \"forager {}\" \"User Commands\"\n"
      ".SH NAME\nforager \\- {}\n"
      ".SH SYNOPSIS\n\\fBforager\\fR \\fIcommand\\fR [\\fIoptions\\fR]\n.br\n"
      "\\fBforager\\fR [\\fIcommand\\fR] \\fB\\-\\-help\\fR\n.br\n\\fBforager\\fR \\fB\\-\\-version\\fR\n"
      ".SH COMMANDS\n",
      version, roff(app.get_description()));
  add_commands(page, app);
  return page + std::string(kRest);
}

void add_manual_command(CLI::App& app, const std::string& version, int& exit_code) {
  CLI::App* sub = app.add_subcommand("manual", "Print the manual page: forager manual | man -l -");
  auto output = std::make_shared<std::string>("-");
  sub->add_option("--output", *output, "File to write it to")->capture_default_str();
  sub->callback([&app, version, output, &exit_code] {
    const auto written = write_output(*output, manual_page(app, version));
    exit_code = written ? kExitDone : complain(written.error());
  });
}

}  // namespace forager::tools
