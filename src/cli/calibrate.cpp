// papilla calibrate: fits the finger to measured friction or published numbers.
#include "calibrate/calibrate.h"

#include <filesystem>
#include <iostream>
#include <memory>

#include "base/error.h"
#include "base/files.h"
#include "cli/commands.h"
#include "design/design.h"
#include "report/page.h"

namespace papilla {
namespace {

struct CalibrateCommand {
  std::string file, out;
  int jobs = 0;
  bool json = false;
};

int run(const Context& context, const CalibrateCommand& command) {
  Calibration calibration = read_calibration(command.file);
  CalibrationOptions options;
  options.threads = command.jobs;
  options.note = [&](const std::string& text) { context.note(text); };
  const CalibrationResult result = calibrate(calibration, options);
  const std::string markdown = calibration_markdown(calibration, result);
  const std::string json = calibration_json(calibration, result) + "\n";
  const std::string out = !command.out.empty()
                              ? command.out
                              : "results/" + std::filesystem::path(command.file).stem().string();
  std::error_code error;
  std::filesystem::create_directories(out, error);
  if (error) {
    throw InputError({Problem{out, 0, 0, "", "no such folder can be made: " + error.message()}});
  }
  write_finger(out + "/finger.toml", result.finger,
               "Fitted by papilla calibrate " +
                   std::filesystem::path(command.file).filename().string() + "; see fit.md.");
  write_bytes(out + "/fit.md", markdown);
  write_bytes(out + "/fit.json", json);
  write_bytes(out + "/report.html", report_page(out));
  const std::string warning = calibration_warning(result);
  if (!warning.empty()) std::cerr << "warning: " << warning << '\n';
  context.note("wrote " + out);
  if (command.json)
    std::cout << json;
  else
    context.print(markdown);
  return result.fit.converged && warning.empty() ? kSuccess : kWorkFailed;
}

}  // namespace

void add_calibrate(Command app, Context& context) {
  Command command = app.add_command(
      "calibrate", "Fit the finger to measured friction or published numbers, with uncertainties");
  auto options = std::make_shared<CalibrateCommand>();
  command.add_option("file", options->file, "CALIBRATION.toml").required();
  command.add_option("--out", options->out, "Folder of finger.toml, fit.md, fit.json, report.html")
      .type_name("DIR");
  command.add_option("--jobs", options->jobs, "Threads; 0: all processors").range(0, 4096);
  command.add_flag("--json", options->json, "One JSON object on standard output");
  command.on_chosen([&context, options] {
    context.action = [&context, options] { return run(context, *options); };
  });
}

}  // namespace papilla
