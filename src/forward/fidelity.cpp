#include "forward/fidelity.h"

#include "base/error.h"

namespace papilla::forward {

Fidelity fidelity_level(const std::string& name) {
  Fidelity f;
  f.level = name;
  if (name == "search") {
    f.grid = 128;
    f.skins = 8;
    f.estimator = Estimator::Load;
    f.contact_tolerance = 1e-3;
    f.field_tolerance = 1e-2;
    f.coupling_tolerance = 1e-3;
    f.equilibrium_skins = 4;
    f.control_skins = 0;
    f.field_skins = 0;
    f.balance_nodes = 1;
  } else if (name == "draft") {
    f.grid = 128;
    f.skins = 16;
    f.estimator = Estimator::Load;
    f.contact_tolerance = 1e-3;
    f.coupling_tolerance = 1e-3;
    f.field_skins = 1;
    f.balance_nodes = 1;
  } else if (name == "reference") {
    f.grid = 512;
    f.skins = 96;
    f.field_skins = 6;
    f.contact_tolerance = 1e-6;
    f.field_tolerance = 1e-5;
    f.coupling_tolerance = 5e-4;
    f.coupling_passes = 40;
    f.bridge_nodes = 6;
    f.balance_nodes = 4;
  } else if (name != "design") {
    throw InputError("unknown accuracy level \"" + name + "\"; use draft, design or reference");
  }
  return f;
}

}  // namespace papilla::forward
