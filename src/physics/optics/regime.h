// Which theory says how a texture looks.
#pragma once

#include "base/rooms.h"

namespace papilla::optics {

// Refused: no numbers.
enum class OpticsRegime { Flat, PhaseScreen, EffectiveMedium, Rigorous, Refused };

// "flat", "phase screen", "effective medium", "rigorous", "refused"
const char* text(OpticsRegime regime);

}  // namespace papilla::optics
