// The scene in the terms of each piece of physics: one question each, no coupling.
#pragma once

#include <memory>

#include "base/rooms.h"
#include "fields/gap.h"
#include "fields/wetting.h"
#include "physics/capillary/water.h"
#include "physics/contact/contact.h"
#include "physics/electrostatics/field.h"
#include "scene/scene.h"

namespace papilla::forward {

// The finger in its state, and what that changes of the surface's shear strength. Eq. scene.12
Scene in_its_state(const Scene& scene);

// The soft features of a surface (particles) as one body on what does not give: a thickness by
// their volume, and the share of the patch that is solid. None: rigid, or without relief.
struct CompliantBody {
  double thickness = 0;  // [m]
  double solid = 0;

  bool present() const { return thickness > 0; }
  // How much a mean pressure brings the surfaces together [m/Pa]: Eq. contact.17
  double compliance(const Surface& surface) const;
};
CompliantBody compliant_body(const Surface& surface, const Heightmap& height);

// Interfacial shear strength of the scene's surface [Pa]; the scene is in its state.
double shear_strength(const Scene& scene, double relative_humidity);

// The contact kernel of a humidity. Skin on a rigid surface softens as a whole, so the kernel at
// 15 % RH serves all humidities (see the softness in forward/coupling.cpp); a compliant surface
// does not soften, and needs one each.
std::shared_ptr<const ContactKernel> contact_kernel(const Scene& scene, const CompliantBody& body,
                                                    const Grid& grid, double relative_humidity);

// Water on the skin and on a surface at a contact angle [rad].
WaterProperties water_properties(const Scene& scene, double substrate_angle);

// Whether the capillary force counts before the drive: preset m3 has none where bridges push.
bool capillary_off_counts(const Scene& scene);
// Whether contact-angle hysteresis holds the finger: preset m3 counts it only there.
bool retention_counts(const Scene& scene);

// The rule in use: columns where the preset is the paper's, whose rules are made for them.
FieldMethod field_method(const ModelOptions& model);

// The film on the electrode. Preset m3 takes it as equally thick along z whatever the surface: its
// columns have the thickness of a flat film.
std::vector<FilmLayer> film_of(const Scene& scene);

// The electrical problem of the scene at a humidity.
FieldProblem field_problem(const Scene& scene, double relative_humidity);

// The pull by the scene's field rule; tolerance: of the potential that spreads in the dielectric.
FieldSolution solve_field(const Scene& scene, const Gap& gap, const CoveredSurface* surface,
                          const Wetting& wetting, const FieldProblem& problem, double tolerance);

// Contact angle of the surface under the scene's drive (electrowetting) [rad].
double driven_contact_angle(const Scene& scene, double relative_humidity);

}  // namespace papilla::forward
