// A stated spectrum pressed on an elastic half-space as a file (`papilla solve contact CASE.toml`):
// contact area, distributions of gap and pressure and what a field makes of the gaps, over seeds.
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "base/rooms.h"
#include "cases/persson.h"
#include "config/reader.h"
#include "numerics/statistics.h"

namespace papilla::cases {

// What presses: both surfaces' roughness on the softer of them.
struct PressedSettings {
  SpectrumSettings roughness;
  double slope = 0;  // rms slope that the waves on the square are scaled to; 0: as they are
};

struct PressSettings {
  double modulus = 0;            // E* of both bodies [Pa]
  double hardness = 0;           // cap on the pressure [Pa]; 0: none
  std::vector<double> pressure;  // mean ones [Pa]
};
void fields(FieldVisitor& v, PressSettings& s);

struct SamplingSettings {
  double size = 0;  // side of the periodic square [m]; 0: the longest wave
  int grid = 512;
  int seeds = 8;     // random phases
  int seed = 1;      // the first of them
  int controls = 2;  // of the seeds on half the pixels, for what the grid leaves
  double tolerance = 1e-6;
};
void fields(FieldVisitor& v, SamplingSettings& s);

struct StatisticsCase {
  int schema_version = 1;
  std::string title;
  PressedSettings pressed;
  PressSettings press;
  std::vector<double> thickness;  // d/eps in series with the gap [m]
  SamplingSettings sampling;

  PowerSpectrum spectrum() const;
  double side() const;
};
void fields(FieldVisitor& v, StatisticsCase& s);

// Throws InputError with every problem.
StatisticsCase read_statistics(const std::string& path,
                               const std::vector<std::string>& overrides = {});
StatisticsCase read_statistics(Document document);

// A mean over the seeds. seeds: its standard error by them; grid: what half the pixels change.
// Nothing where one was not measured: of one seed, without controls.
struct StatisticsNumber {
  double value = 0;
  std::optional<double> seeds{}, grid{};

  std::optional<double> error() const;  // of the parts that were measured
};

// A share of the area per unit of what it is over: bins of equal width from 0.
struct Distribution {
  double width = 0;
  std::vector<Estimate> density;
};

struct StatisticsPoint {
  double pressure = 0;            // [Pa]
  StatisticsNumber area, pixels;  // share in contact: by its edge, and by counting pixels
  StatisticsNumber mean_gap;      // [m]
  // Means of 1/(g + h0) [1/m] and 1/(g + h0)^2 [1/m^2], one per thickness. Eq. contact.18
  std::vector<StatisticsNumber> inverse, inverse_square;
  Distribution gap, stress;  // over gap [m] and pressure [Pa] of the pixels
};

struct StatisticsResult {
  StatisticsNumber rms, slope;  // of the surfaces [m], [-]
  std::vector<StatisticsPoint> points;
  double largest_certificate = 0;
  bool converged = true;
};
// seeds x pressures contacts: seconds at 512 pixels. The same numbers for any number of threads.
StatisticsResult solve_statistics(const StatisticsCase& c, int threads = 0);

}  // namespace papilla::cases
