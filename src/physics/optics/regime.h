// Which theory says how a texture looks.
#pragma once

namespace papilla {

enum class OpticsRegime { Flat, PhaseScreen, EffectiveMedium, Refused };  // Refused: no numbers

// "flat", "phase screen", "effective medium", "refused"
const char* text(OpticsRegime regime);

}  // namespace papilla
