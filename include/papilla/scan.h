// A measured map as every command takes it, and what it is in the words of ISO 25178-2.
// docs/how_to/scans.md
#pragma once

#include <string>

#include "papilla/design.h"

namespace papilla::api {

struct ScanOptions {
  double width = 0;    // [m], where the file does not say; 0: the file must
  bool fill = false;   // heights that are no numbers get those around them; else they are refused
  bool as_is = false;  // neither levelled nor mended: a surface that is known and repeats
  double tip = 0;      // radius of the instrument's tip [m], for the band that it knows; 0: none
};

struct Scan {
  Heights heights;      // as they are taken
  std::string changes;  // what was changed of the map, for people
  std::string json;     // what `papilla surface --json` prints
};

// A file that is not there is looked for among the shipped designs. Throws InputError for a file
// that is no map, that holds no size, or heights that no surface has.
Scan read_scan(const std::string& file, const ScanOptions& options = {});

// The same of a map of the caller's own, as it is. tip: as of ScanOptions. Throws InputError.
Scan measured(const Heights& heights, double tip = 0);

}  // namespace papilla::api
