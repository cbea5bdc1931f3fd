#include "forward/forward.h"

namespace papilla {

Response evaluate(const Scene& scene, const Texture& texture, const Fidelity& fidelity) {
  PatchSet patches = solve_patches(scene, texture, fidelity);
  measure_errors(scene, texture, fidelity, patches);
  return respond(scene, fidelity, patches);
}

}  // namespace papilla
