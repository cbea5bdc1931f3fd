#include "report/fit_folder.h"

#include <filesystem>
#include <optional>

#include "base/folder.h"
#include "claims/reproduce.h"
#include "design/design.h"
#include "published/targets.h"
#include "report/page.h"
#include "report/sums.h"

namespace papilla::report {
namespace {

// The claims of both lists, before the fit and after it.
JudgedFit judged(const Calibration& calibration, const CalibrationResult& result,
                 const FitOptions& how) {
  ReproduceOptions options;
  for (const auto* list : {&calibration.fit, &calibration.hold_out}) {
    for (const std::string& id : *list) {
      if (id != kGapTarget && id != kFrictionTarget) options.ids.push_back(id);
    }
  }
  if (options.ids.empty()) return {};
  if (how.note) how.note("claims on other skins");
  options.threads = how.threads;
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

void write_fitted(const Folder& folder, const FitReport& fit) {
  Finger finger = fit.result.finger;
  if (fit.result.belief) {
    folder.write("belief.toml", "# " + fit.result.belief->belief.made_of + "; see fit.md.\n" +
                                    belief_text(fit.result.belief->belief));
    finger.belief = "belief.toml";  // beside it
  }
  write_finger(folder.path("finger.toml"), finger,
               "Fitted by papilla calibrate " +
                   std::filesystem::path(fit.calibration.file).filename().string() +
                   "; see fit.md.");
}

void write_report(const Folder& folder, const FitReport& fit) {
  folder.write("fit.md", fit.markdown);
  folder.write("fit.json", fit.json + "\n");
  write_sums(folder);
  folder.write(kPageName, report_page(folder.path()));
}

}  // namespace

FitReport fit_to_folder(const std::string& file, const FitOptions& options) {
  std::optional<Folder> folder;
  FitReport fit;
  fit.calibration = read_calibration(file, m3_claim_ids());
  if (options.note) {
    for (const std::string& note : fit.calibration.data_notes) options.note(note);
  }
  if (!options.folder.empty()) folder = Folder::made(options.folder);
  fit.result = fit_finger(fit.calibration, {options.threads, true, options.note, options.folder});
  // At once: what the fit has cost is not lost to a claim that cannot be judged.
  if (folder) write_fitted(*folder, fit);
  const JudgedFit claims = judged(fit.calibration, fit.result, options);
  fit.markdown = calibration_markdown(fit.calibration, fit.result, claims);
  fit.json = calibration_json(fit.calibration, fit.result, claims);
  if (folder) write_report(*folder, fit);
  return fit;
}

}  // namespace papilla::report
