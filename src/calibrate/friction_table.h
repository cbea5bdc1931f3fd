// The user's table of measured friction.
#pragma once

#include <string>
#include <vector>

namespace papilla {

// One row of measured friction; a line of the user's table.
struct FrictionDatum {
  std::string design;                                                    // file
  double relative_humidity = 0, amplitude = 0, frequency = 0, load = 0;  // SI
  double off = 0, off_sd = 0, on = 0, on_sd = 0;                         // [N]; on_sd 0: not driven
  int line = 0;
};

// `design,relative_humidity,amplitude_V,frequency_Hz,load_N,F_off_N,F_off_sd_N,F_on_N,F_on_sd_N`:
// designs beside the table, humidity as "15 %" or 0.15; empty F_on where nothing is driven. Throws
// InputError with every bad cell, each with its line; a friction over ten times the load is one.
std::vector<FrictionDatum> read_friction(const std::string& path);

}  // namespace papilla
