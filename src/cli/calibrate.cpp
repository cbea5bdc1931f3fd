// papilla calibrate: fits the finger to measured friction or published numbers.
#include "calibrate/calibrate.h"

#include <filesystem>
#include <iostream>
#include <memory>

#include "base/error.h"
#include "base/files.h"
#include "claims/reproduce.h"
#include "cli/commands.h"
#include "design/design.h"
#include "published/targets.h"
#include "report/fit.h"
#include "report/page.h"

namespace papilla::cli {
namespace {

struct CalibrateCommand {
  std::string file, out;
  int jobs = 0;
  bool json = false;
};

// The claims of both lists, before the fit and after it.
JudgedFit judged(const Calibration& calibration, const CalibrationResult& result, int jobs,
                 const Context& context) {
  ReproduceOptions options;
  for (const auto* list : {&calibration.fit, &calibration.hold_out}) {
    for (const std::string& id : *list) {
      if (id != kGapTarget) options.ids.push_back(id);
    }
  }
  if (options.ids.empty()) return {};
  context.note("claims on other skins");
  options.threads = jobs;
  options.sampling = calibration.check;
  options.one_preset = true;
  JudgedFit out;
  options.finger = result.start;
  options.finger.fitted_to = result.finger.fitted_to;
  out.before = reproduce(options);
  options.finger = result.finger;
  out.after = reproduce(options);
  return out;
}

int run(const Context& context, const CalibrateCommand& command) {
  const Calibration calibration = read_calibration(command.file, m3_claim_ids());
  CalibrationOptions options;
  options.threads = command.jobs;
  options.note = [&](const std::string& text) { context.note(text); };
  const std::string out = !command.out.empty()
                              ? command.out
                              : "results/" + std::filesystem::path(command.file).stem().string();
  std::error_code error;
  std::filesystem::create_directories(out, error);
  if (error) {
    throw InputError({Problem{out, 0, 0, "", "no such folder can be made: " + error.message()}});
  }
  const CalibrationResult result = fit_finger(calibration, options);
  // At once: what the fit has cost is not lost to a claim that cannot be judged.
  write_finger(out + "/finger.toml", result.finger,
               "Fitted by papilla calibrate " +
                   std::filesystem::path(command.file).filename().string() + "; see fit.md.");
  const JudgedFit claims = judged(calibration, result, command.jobs, context);
  const std::string markdown = calibration_markdown(calibration, result, claims);
  const std::string json = calibration_json(calibration, result, claims) + "\n";
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
  return result.fit.converged && explains_data(result) ? kSuccess : kWorkFailed;
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

}  // namespace papilla::cli
