#include "papilla/calibrate.h"

#include <filesystem>

#include "api/inside.h"
#include "config/writer.h"
#include "report/fit_folder.h"

namespace papilla::api {

CalibrateResult calibrate(const std::string& file, const CalibrateOptions& options) {
  return across([&] {
    require_threads(options.threads);
    Watch watch({}, options.stop);
    const FitReport fit = fit_to_folder(file, {options.threads, options.folder, options.progress});
    CalibrateResult out;
    out.converged = fit.result.fit.converged;
    out.explains_data = rooms::explains_data(fit.result);
    out.warning = calibration_warning(fit.result);
    for (const ParameterFit& p : fit.result.fit.parameters)
      out.parameters.push_back({p.name, p.value, p.se, p.low, p.high, p.data_share});
    out.chi2_before = fit.result.chi2_before;
    out.chi2 = fit.result.fit.chi2;
    out.degrees_of_freedom = fit.result.fit.degrees_of_freedom;
    Finger finger = fit.result.finger;
    if (fit.result.belief && !options.folder.empty())  // where it can be read from anywhere
      finger.belief = std::filesystem::absolute(options.folder) / "belief.toml";
    out.finger = "schema_version = 1\n" + to_toml(finger);
    out.table = fit.markdown;
    out.json = fit.json;
    return out;
  });
}

}  // namespace papilla::api
