#include "report/fit_folder.h"

#include <filesystem>
#include <system_error>

#include "base/error.h"
#include "base/files.h"
#include "claims/reproduce.h"
#include "design/design.h"
#include "published/targets.h"
#include "report/page.h"

namespace papilla::report {
namespace {

// The claims of both lists, before the fit and after it.
JudgedFit judged(const Calibration& calibration, const CalibrationResult& result,
                 const FitOptions& how) {
  ReproduceOptions options;
  for (const auto* list : {&calibration.fit, &calibration.hold_out}) {
    for (const std::string& id : *list) {
      if (id != kGapTarget) options.ids.push_back(id);
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

void make_fit_folder(const std::string& folder) {
  std::error_code error;
  std::filesystem::create_directories(folder, error);
  if (error) {
    throw InputError({Problem{folder, 0, 0, "", "no such folder can be made: " + error.message()}});
  }
}

void write_fitted(const std::string& folder, const FitReport& fit) {
  write_finger(folder + "/finger.toml", fit.result.finger,
               "Fitted by papilla calibrate " +
                   std::filesystem::path(fit.calibration.file).filename().string() +
                   "; see fit.md.");
}

void write_report(const std::string& folder, const FitReport& fit) {
  write_bytes(folder + "/fit.md", fit.markdown);
  write_bytes(folder + "/fit.json", fit.json + "\n");
  write_bytes(folder + "/report.html", report_page(folder));
}

}  // namespace

FitReport fit_to_folder(const std::string& file, const FitOptions& options) {
  const bool kept = !options.folder.empty();
  FitReport fit;
  fit.calibration = read_calibration(file, m3_claim_ids());
  if (kept) make_fit_folder(options.folder);
  fit.result = fit_finger(fit.calibration, {options.threads, true, options.note, options.folder});
  // At once: what the fit has cost is not lost to a claim that cannot be judged.
  if (kept) write_fitted(options.folder, fit);
  const JudgedFit claims = judged(fit.calibration, fit.result, options);
  fit.markdown = calibration_markdown(fit.calibration, fit.result, claims);
  fit.json = calibration_json(fit.calibration, fit.result, claims);
  if (kept) write_report(options.folder, fit);
  return fit;
}

}  // namespace papilla::report
