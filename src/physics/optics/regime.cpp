#include "physics/optics/regime.h"

#include "base/check.h"

namespace papilla::optics {

const char* text(OpticsRegime regime) {
  switch (regime) {
    case OpticsRegime::Flat:
      return "flat";
    case OpticsRegime::PhaseScreen:
      return "phase screen";
    case OpticsRegime::EffectiveMedium:
      return "effective medium";
    case OpticsRegime::Rigorous:
      return "rigorous";
    case OpticsRegime::Refused:
      return "refused";
  }
  PAPILLA_CHECK(false, "a regime without words");
  return "";
}

}  // namespace papilla::optics
