// Settled droplets for people and programs, and as a picture.
#pragma once

#include <string>

#include "base/rooms.h"
#include "cases/droplets.h"

namespace papilla::report {

std::string droplets_text(const DropletCase& c, const DropletResult& result);
// Schema 1, SI; seconds: what the solution took.
std::string droplets_json(const DropletCase& c, WaterModel model, const DropletResult& result,
                          double seconds);
std::string droplet_ensemble_text(const DropletEnsemble& ensemble);
std::string droplet_ensemble_json(const DropletEnsemble& ensemble);

// PNG of the initial (left) and final droplets: bridges blue, film cyan, on the surface orange, on
// the skin magenta; gap in grey, bright: wide, with its scale bar. Throws InputError.
void write_droplet_picture(const std::string& path, const Gap& gap, const Wetting& initial,
                           const Wetting& final);

}  // namespace papilla::report
