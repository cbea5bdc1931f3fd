// Error of the contact area against what it costs: estimators and grids on the same skins. Rows of
// docs/theory/contact.md and of the accuracy report.
#pragma once

#include <string>
#include <vector>

namespace papilla {

struct AreaErrorRow {
  std::string scene;      // "loaded": the reference finger at 15 % RH; "light": 15 kPa
  std::string method;     // "pixels", "perimeter", "near-edge", "refined" (near-edge on points)
  int grid = 0;           // pixels along the patch on which the area is measured
  double per_cutoff = 0;  // pixels a cut-off wavelength
  double contacts = 0;    // pixels under pressure, mean over skins
  double bias = 0;        // mean relative error
  double scatter = 0;     // its standard deviation over skins
  double stated = 0;      // mean of the stated standard error, relative; 0: none is stated
  double ratio_bias = 0;  // of area at 1.3 times the load over area at the load, relative
  double ratio_scatter = 0;
  double seconds = 0;  // of one cold solve and its area, processor time
  double pairs = 0;    // its transform pairs, in units of the grid solved
};

struct AreaErrorOptions {
  int smallest = 128, largest = 1024;  // grids, each twice the one before
  int reference = 2048;                // of the near-edge areas that the errors are counted from
  int skins = 3;
  double tolerance = 1e-6;
};

// Rows of one scene, coarse grids first. "refined" rows of the light scene start from the solution
// on a grid four times coarser. Throws InputError for another scene. Cost of the defaults: loaded
// some 20 s, light some 10 s.
std::vector<AreaErrorRow> area_error_against_time(const std::string& scene,
                                                  const AreaErrorOptions& options);

// The rows as CSV, with the line of names first.
std::string area_error_csv(const std::vector<AreaErrorRow>& rows);

}  // namespace papilla
