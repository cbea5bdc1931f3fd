// Error of the contact area against time, loaded and light: estimators and grids on the same skins.
// Rows of docs/theory/contact.md.
//     contact_area_bench > results/bench/contact_area.csv
#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <ctime>
#include <string>
#include <vector>

#include "base/error.h"
#include "base/memory.h"
#include "geometry/roughness.h"
#include "numerics/statistics.h"
#include "physics/contact/contact.h"
#include "scene/finger.h"

namespace papilla::tests {
namespace {

struct AreaErrorRow {
  std::string scene;      // "loaded": the reference finger at 15 % RH; "light": 15 kPa
  std::string method;     // "pixels", "perimeter", "near-edge"
  int grid = 0;           // pixels along the patch on which the area is measured
  double per_cutoff = 0;  // pixels per cut-off wavelength
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

constexpr double kMoreLoad = 1.3;

struct Case {
  Spectrum spectrum;
  LayeredSolid solid;
  double pressure;
};

Case case_of(const std::string& scene) {
  if (scene == "light") {
    return {{330e-9, 12e-6, 0.8, 50e-9}, {200e6, 0.5, 1e-6, 25e6, 0.5}, 15e3};
  }
  if (scene != "loaded") throw InputError("area errors are known of \"loaded\" and \"light\"");
  const Finger finger;
  const Skin& s = finger.skin;
  return {{s.rms, s.roll_off, s.hurst, s.cutoff},
          {s.layer_modulus, s.layer_poisson, s.layer_thickness, s.bulk_modulus, s.bulk_poisson},
          finger.patch_pressure(0.15)};
}

// Processor time: other work on the machine does not count.
double now() { return static_cast<double>(std::clock()) / CLOCKS_PER_SEC; }

// Area at the load and at 1.3 times it, by one method.
struct Pair {
  double area = 0, more = 0;
  double ratio() const { return more / area; }
};

struct Solved {
  Pair by[3];  // pixels, perimeter, near-edge
  double stated = 0, contacts = 0, seconds = 0, pairs = 0;
  ContactSolution low, high;
};

Solved solve(const Case& c, const ContactKernel& kernel, const Heightmap& h, double tolerance) {
  Solved out;
  const double begin = now();
  out.low = solve_contact(kernel, h.z, c.pressure, {}, {.tolerance = tolerance});
  const ContactArea area = measure_area(kernel, out.low);
  out.seconds = now() - begin;
  out.pairs = out.low.fft_pairs;
  out.high =
      solve_contact(kernel, h.z, kMoreLoad * c.pressure, {}, {.tolerance = tolerance}, &out.low);
  const ContactArea more = measure_area(kernel, out.high);
  out.by[0] = {area.raw, more.raw};
  out.by[1] = {area.perimeter, more.perimeter};
  out.by[2] = {area.near_edge, more.near_edge};
  out.stated = area.se / area.near_edge;
  out.contacts = area.raw * static_cast<double>(kernel.grid().size());
  return out;
}

// Gathers the skins of one row.
class Row {
 public:
  Row(const std::string& scene, const std::string& method, int grid, double per_cutoff) {
    row_.scene = scene;
    row_.method = method;
    row_.grid = grid;
    row_.per_cutoff = per_cutoff;
  }
  void add(const Pair& value, const Pair& reference, double stated, double contacts, double seconds,
           double pairs) {
    area_.push_back(value.area / reference.area - 1);
    ratio_.push_back(value.ratio() / reference.ratio() - 1);
    stated_.push_back(stated);
    contacts_.push_back(contacts);
    seconds_.push_back(seconds);
    pairs_.push_back(pairs);
  }
  AreaErrorRow done() {
    const Estimate area = mean_estimate(area_), ratio = mean_estimate(ratio_);
    const double root = std::sqrt(static_cast<double>(area_.size()));
    row_.bias = area.value;
    row_.scatter = area.se * root;
    row_.ratio_bias = ratio.value;
    row_.ratio_scatter = ratio.se * root;
    row_.stated = mean_estimate(stated_).value;
    row_.contacts = mean_estimate(contacts_).value;
    row_.seconds = mean_estimate(seconds_).value;
    row_.pairs = mean_estimate(pairs_).value;
    return row_;
  }

 private:
  AreaErrorRow row_;
  std::vector<double> area_, ratio_, stated_, contacts_, seconds_, pairs_;
};

// Rows of one scene, coarse grids first. Throws InputError for another scene. Cost of the defaults:
// loaded some 20 s, light some 10 s.
std::vector<AreaErrorRow> area_error_against_time(const std::string& scene,
                                                  const AreaErrorOptions& options) {
  const Case c = case_of(scene);
  const auto square_grid = [](int n) { return Grid{n, n, 12e-6, 12e-6}; };
  const auto skin = [&](const Grid& grid, int k) {
    return random_surface(c.spectrum, grid, 1, static_cast<std::uint64_t>(k));
  };
  const auto per_cutoff = [&](const Grid& grid) { return c.spectrum.cutoff / grid.dx(); };
  std::vector<Pair> reference;
  const Grid finest = square_grid(options.reference);
  for (int k = 0; k < options.skins; ++k) {
    reference.push_back(
        solve(c, *make_contact_kernel(finest, c.solid), skin(finest, k), options.tolerance).by[2]);
  }

  static const char* const kMethods[3] = {"pixels", "perimeter", "near-edge"};
  std::vector<AreaErrorRow> rows;
  for (int n = options.smallest; n <= options.largest; n *= 2) {
    const Grid grid = square_grid(n);
    const auto kernel = make_contact_kernel(grid, c.solid);
    std::vector<Row> row;
    for (const char* method : kMethods) row.emplace_back(scene, method, n, per_cutoff(grid));
    for (int k = 0; k < options.skins; ++k) {
      const auto at = static_cast<std::size_t>(k);
      const Heightmap h = skin(grid, k);
      const Solved s = solve(c, *kernel, h, options.tolerance);
      for (std::size_t m = 0; m < row.size(); ++m) {
        row[m].add(s.by[m], reference[at], m == 2 ? s.stated : 0, s.contacts, s.seconds, s.pairs);
      }
    }
    for (Row& r : row) rows.push_back(r.done());
  }
  return rows;
}

std::string area_error_csv(const std::vector<AreaErrorRow>& rows) {
  std::string text =
      "scene,method,grid,pixels_per_cutoff,contact_pixels,bias_percent,scatter_percent,"
      "stated_se_percent,ratio_bias_percent,ratio_scatter_percent,seconds,pairs\n";
  for (const AreaErrorRow& r : rows) {
    text += fmt::format("{},{},{},{:.2f},{:.0f},{:.2f},{:.2f},{:.2f},{:.2f},{:.2f},{:.5f},{:.1f}\n",
                        r.scene, r.method, r.grid, r.per_cutoff, r.contacts, 100 * r.bias,
                        100 * r.scatter, 100 * r.stated, 100 * r.ratio_bias, 100 * r.ratio_scatter,
                        r.seconds, r.pairs);
  }
  return text;
}

}  // namespace
}  // namespace papilla::tests

int main() {
  papilla::tests::keep_freed_memory();
  std::vector<papilla::tests::AreaErrorRow> rows;
  for (const char* scene : {"loaded", "light"}) {
    for (const auto& row : papilla::tests::area_error_against_time(scene, {.skins = 4})) {
      rows.push_back(row);
    }
  }
  fmt::print("{}", area_error_csv(rows));
}
