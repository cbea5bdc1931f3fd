// papilla calibrate: fits the finger to measured friction or published numbers.
#include "calibrate/calibrate.h"

#include <filesystem>
#include <iostream>
#include <memory>

#include "base/text.h"
#include "base/watch.h"
#include "cli/commands.h"
#include "cli/interrupt.h"
#include "report/fit_folder.h"

namespace papilla::cli {
namespace {

struct CalibrateCommand {
  std::string file, out;
  int jobs = 0;
  bool json = false;
};

int run(const Context& context, const CalibrateCommand& command) {
  const std::string out = !command.out.empty()
                              ? command.out
                              : "results/" + std::filesystem::path(command.file).stem().string();
  const Interruptible interrupt;
  const Watch watch({}, &interrupt.asked());
  FitReport fit;
  try {
    fit = fit_to_folder(command.file,
                        {command.jobs, out, [&](const std::string& text) { context.note(text); }});
  } catch (const WorkStopped&) {
    context.note("interrupted; what is done is kept in " + out + ", the same command goes on");
    return interrupt.status();
  }
  const std::string warning = calibration_warning(fit.result);
  if (!warning.empty()) std::cerr << "warning: " << visible(warning) << '\n';
  context.note("wrote " + out);
  if (command.json)
    std::cout << fit.json << '\n';
  else
    context.print(fit.markdown);
  return fit.result.fit.converged && explains_data(fit.result) ? kSuccess : kWorkFailed;
}

}  // namespace

void add_calibrate(Command app, Context& context) {
  Command command = app.add_command(
      "calibrate", "Fit the finger to measured friction or published numbers, with uncertainties");
  auto options = std::make_shared<CalibrateCommand>();
  command.add_option("file", options->file, "CALIBRATION.toml").required();
  command
      .add_option("--out", options->out,
                  "Folder of finger.toml, belief.toml, fit.md, fit.json, report.html")
      .type_name("DIR");
  command.add_option("--jobs", options->jobs, "Threads; 0: all processors").range(0, 4096);
  command.add_flag("--json", options->json, "One JSON object on standard output");
  command.document(
      {"Fits numbers of the finger to measured frictions (a CSV) or to published numbers, with "
       "priors: "
       "values, intervals, correlations, what the data cannot tell apart and, with a section "
       "[belief], a "
       "weighted set of fingers that every answer carries on. Ctrl-C keeps what is computed.",
       {{"papilla calibrate fingers/reference.calibration.toml --out results/fit",
         "the fit of the shipped finger"}},
       {{"DIR/finger.toml, belief.toml", "the fitted finger; what the data leave open of it"},
        {"DIR/fit.md, fit.json, report.html", "how well it explains the data"}}});
  command.on_chosen([&context, options] {
    context.action = [&context, options] { return run(context, *options); };
  });
}

}  // namespace papilla::cli
