// Whole cases without a texture: the mean field of a rough skin under voltage, and the way from a
// source to the force on a finger. As `papilla solve persson` and `papilla solve drive` take them.
#pragma once

#include <string>
#include <vector>

#include "papilla/design.h"

namespace papilla::api {

// A case: a file (looked for as Design::read does), or the text of one where `file` is empty; with
// values that replace its own.
struct CaseInput {
  std::string file, toml;
  Design::Values values;
};

struct PerssonPoint {
  double voltage = 0, load = 0, frequency = 0;  // peak [V], [N], [Hz]
  // No equilibrium below 1 GPa, or more than its strength on the dielectric where the skin touches
  // it: the numbers under voltage, and the capacitance, are NaN.
  bool collapsed = false, breaks_down = false;
  // The pressure is at the hardness or beyond: the numbers under voltage mean nothing.
  bool yielded = false;
  double area_off = 0, area_on = 0;      // share of the nominal area in contact
  double pressure = 0, pull = 0;         // total, time mean of the electrostatic part [Pa]
  double mean_gap = 0;                   // [m]
  double friction = 0, coefficient = 0;  // [N]
  double capacitance = 0;                // [F]
};

struct PerssonResult {
  double rms = 0, slope = 0, contact_modulus = 0;  // of the spectrum [m]; [Pa]
  PerssonPoint point;
  std::vector<PerssonPoint> over_voltage, over_load, over_frequency;  // of the case's sweeps
  std::string json, table;                                            // of the command
};
// docs/theory/persson.md. Throws InputError.
PerssonResult persson(const CaseInput& input);

struct DriveResult {
  double period = 0;                                                         // of the series [s]
  std::vector<double> source_voltage, current, gap_voltage, pull, friction;  // [V], [A], [V], [N]
  std::vector<double> line_frequency, line_amplitude;  // spectrum of the friction [Hz], [N]
  double mean_pull = 0, distortion = 0;
  std::string json, table;  // of the command
};
// docs/theory/drive.md. Throws InputError.
DriveResult drive(const CaseInput& input);

}  // namespace papilla::api
