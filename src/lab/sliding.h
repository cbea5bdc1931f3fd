// Where a finger slides steadily in a record, stroke by stroke: onset, plateau, slips, and when the
// drive was on. Equations lab.11-13: docs/theory/lab.md.
#pragma once

#include <cstddef>
#include <string>
#include <vector>

#include "base/rooms.h"
#include "lab/trace_file.h"

namespace papilla::lab {

// Samples from `begin` to before `end`.
struct Span {
  std::size_t begin = 0, end = 0;

  std::size_t size() const { return end - begin; }
  bool operator==(const Span&) const = default;
};

struct Stroke {
  Span all, steady;                // steady: empty where the finger never slides steadily
  int direction = 1;               // sign of the tangential force less the sensor's zero
  std::size_t onset = 0;           // the sample at which sliding begins
  double peak = 0;                 // static friction [N], at the onset; the zero may be in it
  std::vector<std::size_t> slips;  // samples at which a slip begins
  double slip = 0;                 // median fall of the force in a slip [N]

  // Slips that follow one another make the sliding none that is steady.
  bool sticks() const { return slips.size() >= 3; }
};

struct Sliding {
  std::vector<Stroke> strokes;
  std::vector<bool> on;  // of each sample: the drive; empty: no voltage anywhere
  std::size_t edge = 0;  // samples that its switches are blurred by
  double voltage = 0;    // peak of the drive while it is on
  double rate = 0;       // samples a second
  std::vector<std::string> notes;
};

// Cost: linear in the samples; 0.3 s for 10^6.
Sliding find_sliding(const Trace& trace);

}  // namespace papilla::lab
