// The voltage that a modulation takes, and what comes first where none does.
#pragma once

#include <span>

#include "base/rooms.h"
#include "forward/forward.h"

namespace papilla::estimate {

// Amplitude at which the dielectric breaks down, edges of the electrode's stated radius and side
// walls of the texture's stated slopes included (Eq. electrostatics.9) [V]; 0 without a dielectric,
// and where directional layers leave a wall bare. Layers divide it as they do at the drive's
// frequency.
double breakdown_voltage(const Surface& surface, const Texture& texture, const Drive& drive);

// That over an amplitude, known before any field is solved: a bridge or a contact puts all of it on
// the thinnest place. Infinite where a layer leaks at the drive's frequency and the field alone can
// say.
double bridged_margin(const Surface& surface, const Texture& texture, const Drive& drive,
                      double amplitude);

// Sets that of every point of a response, at the voltage of its source.
void set_bridged_margins(Response& response, const Scene& scene, const Texture& texture);

// Largest amplitude a design may be driven with [V]: up to its breakdown, or what the source gives.
double amplitude_limit(const Scene& scene, const Texture& texture);

// Adds to every point of a response of that scene the amplitude at which its modulation reaches
// each target (> 0). Waveform and frequency are the scene's, its amplitude does not matter: the
// field is corrected as at the answer, to a percent of the pull. Root of
// a rising function to 1e-3 of the amplitude, by secants in logarithms within a bracket: first with
// the load estimator on the gap at rest, then, where the fidelity measures areas, with contact
// solved under the drive. Not reached: the status names what came first (breakdown, the source,
// pull-in, a bare electrode, what touches being no conductor, a trouble of the model) and the
// highest modulation. Cost: contact at rest once more, and 5 to 10 times field and water; areas: 3
// to 5 more solves per patch. Eq. metrics.6
void add_voltages(Response& response, const Scene& scene, const Texture& texture,
                  const Fidelity& fidelity, std::span<const double> targets);

}  // namespace papilla::estimate
