// A measured map as it is imported: what was changed, what it is in numbers, for people and as
// JSON.
#pragma once

#include <string>
#include <vector>

#include "base/rooms.h"
#include "geometry/areal.h"
#include "geometry/scan.h"
#include "geometry/spectra.h"

namespace papilla::report {

struct SurfaceView {
  std::string file;
  Scan scan;
  ArealParameters areal;
  std::vector<SpectrumRing> spectrum;
  KnownBand band;
  double tip = 0;  // radius that the band counts with [m]; 0: none
};

SurfaceView view_of(const std::string& file, Scan scan, double tip);
SurfaceView view_of(const ScanSource& source, double tip);

std::string surface_text(const SurfaceView& view);
std::string surface_json(const SurfaceView& view);  // schema 1, SI

// Several maps of one surface: each alone in a line, and what they say of its spectrum together.
struct SurfacesView {
  std::vector<SurfaceView> maps;
  std::vector<JointRing> joint;
  double rms = 0;  // of the wavelengths that the maps know [m]
};
SurfacesView joint_view(std::vector<SurfaceView> maps);
std::string surfaces_text(const SurfacesView& view);
std::string surfaces_json(const SurfacesView& view);  // schema 1, SI

// A JSON document with the member "scan": what was changed of the map behind it.
std::string with_scan(const std::string& document, const std::string& file,
                      const ScanChanges& changes);

}  // namespace papilla::report
