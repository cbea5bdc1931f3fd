// papilla report RESULT_DIR: one self-contained HTML page.
#include <iostream>
#include <memory>
#include <nlohmann/json.hpp>

#include "base/error.h"
#include "base/files.h"
#include "base/text.h"
#include "cli/commands.h"
#include "report/comparison.h"
#include "report/front.h"
#include "report/page.h"
#include "report/pdf.h"
#include "report/sums.h"

namespace papilla::cli {
namespace {

struct ReportOptions {
  std::string folder, other, out, pick, svg;
  bool json = false;
};

// A page for that file: as PDF where it is to be one.
std::string as_wanted(const std::string& file, std::string page) {
  return file.ends_with(".pdf") ? page_as_pdf(page) : std::move(page);
}

// Tables for a terminal, a page where one is asked for.
int compare(const ReportOptions& options) {
  if (!options.pick.empty() || !options.svg.empty())
    throw InputError("--pick and --svg are of one run, not of two");
  if (!options.out.empty())
    write_bytes(end_of_links(options.out),
                as_wanted(options.out, comparison_page(options.folder, options.other)));
  const std::string text = comparison_markdown(options.folder, options.other);
  if (options.json) {
    std::cout << nlohmann::ordered_json{{"schema", 1}, {"file", options.out}, {"text", text}}.dump(
                     2)
              << '\n';
  } else {
    std::cout << text;
    if (!options.out.empty()) std::cout << '\n' << visible(options.out) << '\n';
  }
  return kSuccess;
}

int report(const ReportOptions& options) {
  if (!options.other.empty()) return compare(options);
  const bool picture = !options.svg.empty();
  if (picture && !(options.out.empty() && options.pick.empty()))
    throw InputError(
        "--svg is the picture of the front alone: --out and --pick are of the page, without it");
  const std::string path = picture               ? options.svg
                           : options.out.empty() ? options.folder + "/report.html"
                                                 : options.out;
  const std::string text = picture ? front_svg(options.folder)
                                   : as_wanted(path, report_page(options.folder, options.pick));
  if (const auto changed = changed_files(Folder(options.folder)); !changed.empty())
    std::cerr << "warning: not as the run wrote them, or not to be read: "
              << visible(join_names(changed)) << '\n';
  write_bytes(options.out.empty() && !picture ? path : end_of_links(path), text);
  if (options.json) {
    std::cout << nlohmann::ordered_json{{"schema", 1}, {"file", path}, {"bytes", text.size()}}.dump(
                     2)
              << '\n';
  } else {
    std::cout << visible(path) << '\n';
  }
  return kSuccess;
}

}  // namespace

void add_report(Command app, Context& context) {
  Command command =
      app.add_command("report", "One HTML page of a finished run: charts, pictures, files");
  auto options = std::make_shared<ReportOptions>();
  command
      .add_option("folder", options->folder,
                  "Folder that `papilla optimize`, `rank --out` or `calibrate` wrote")
      .required()
      .type_name("RESULT_DIR");
  command
      .add_option("other", options->other,
                  "Another run of `papilla optimize`: both are compared, on the terminal and, with "
                  "--out, as a page")
      .type_name("RESULT_DIR");
  command
      .add_option(
          "--out", options->out,
          "Default: RESULT_DIR/report.html; a name that ends in .pdf is printed by Chromium")
      .type_name("FILE");
  command.add_option("--svg", options->svg, "The picture of the front alone, to this file")
      .type_name("FILE");
  command.add_flag("--json", options->json, "One JSON object on standard output");
  add_pick_option(command, options->pick);
  command.document(
      {"Writes one HTML page of a finished run, ranking or fit: the recommendation, the front, "
       "curves "
       "with bands, pictures, tables. It opens anywhere, without a network.",
       {{"papilla report results/study", "results/study/report.html"},
        {"papilla report results/study --pick knee --out knee.html",
         "with another design of the front as the best"},
        {"papilla report results/study --svg front.svg", "the picture of the front alone"},
        {"papilla report results/study --out study.pdf", "the page as PDF, where Chromium is"},
        {"papilla report results/first results/second --out both.html",
         "two runs beside each other"}},
       {{"RESULT_DIR/report.html", "the page"}}});
  command.on_chosen(
      [&context, options] { context.action = [options] { return report(*options); }; });
}

}  // namespace papilla::cli
