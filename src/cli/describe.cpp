// papilla describe [SECTION]: the reference of every key.
#include <filesystem>
#include <iostream>
#include <memory>

#include "base/files.h"
#include "cli/commands.h"
#include "cli/manual.h"
#include "report/reference.h"
#include "report/schema.h"

namespace papilla::cli {
namespace {

struct DescribeOptions {
  std::string section, out, manuals;
  bool markdown = false, json = false, schema = false;
};

int describe(const DescribeOptions& options, const Command& program) {
  if (options.schema) {
    std::cout << json_schema() << '\n';
    return kSuccess;
  }
  if (!options.manuals.empty()) {
    std::filesystem::create_directories(options.manuals);
    for (const ManualPage& page : manual_pages(program, PAPILLA_VERSION))
      write_bytes(options.manuals + "/" + page.name + ".1", page.text);
    return kSuccess;
  }
  const auto format = options.markdown ? ReferenceFormat::Markdown : ReferenceFormat::Text;
  if (!options.out.empty()) {
    std::filesystem::create_directories(options.out);
    for (const std::string& section : reference_sections()) {
      write_bytes(options.out + "/" + section + ".md",
                  reference_section(section, ReferenceFormat::Markdown));
    }
    return kSuccess;
  }
  if (options.json) {
    std::cout << reference_json(options.section.empty() ? reference_sections()
                                                        : std::vector{options.section})
              << '\n';
    return kSuccess;
  }
  if (!options.section.empty()) {
    std::cout << reference_section(options.section, format);
    return kSuccess;
  }
  for (const std::string& section : reference_sections()) {
    std::cout << reference_section(section, format) << '\n';
  }
  return kSuccess;
}

}  // namespace

void add_describe(Command app, Context& context) {
  Command command =
      app.add_command("describe", "The reference of every key: unit, range, default, source");
  auto options = std::make_shared<DescribeOptions>();
  command.add_option("section", options->section,
                     "texture, search, texture.depth, ...; all sections when left out");
  command.add_flag("--markdown", options->markdown, "Markdown tables");
  command.add_flag("--json", options->json, "One JSON object on standard output");
  command.add_option("--out", options->out, "Write one Markdown page a section into this folder")
      .type_name("DIR");
  command.add_flag("--json-schema", options->schema,
                   "The JSON Schema of design and study files, for editors");
  command.add_option("--manuals", options->manuals, "Write the manual pages into this folder")
      .type_name("DIR");
  command.document(
      {"Prints the reference of every key of design and study files: unit, range, default, meaning "
       "and "
       "source, and the metrics that studies may name.",
       {{"papilla describe texture.depth", "one key"},
        {"papilla describe metrics", "what can be wanted"},
        {"papilla describe --json-schema", "for editors"}}});
  command.on_chosen([&context, options, app] {
    context.action = [options, app] { return describe(*options, app); };
  });
}

}  // namespace papilla::cli
