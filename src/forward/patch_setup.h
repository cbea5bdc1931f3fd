// What the patches of a scene are made of: surface, skins and water; the finger in its state.
#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "base/rooms.h"
#include "forward/coupling.h"
#include "forward/open_gaps.h"
#include "forward/scene_terms.h"

namespace papilla::forward {

// A volume and a placement of the water on one skin.
struct WaterMember {
  double factor;        // on the volume
  std::uint64_t index;  // of the droplets' random stream
};

// That of a placement of the droplets on a skin.
constexpr std::uint64_t water_stream(int skin, int placement) {
  return static_cast<std::uint64_t>(skin) + (static_cast<std::uint64_t>(placement) << 32);
}

class PatchSetup {
 public:
  PatchSetup(const Scene& scene, const Texture& texture, const Fidelity& fidelity);
  PatchSetup(const PatchSetup&) = delete;
  PatchSetup& operator=(const PatchSetup&) = delete;

  const Scene& scene() const { return scene_; }
  const Plan& plan() const { return plan_; }
  const Fidelity& fidelity() const { return fidelity_; }
  const CoveredSurface& surface() const { return surface_; }
  const Heightmap& texture() const { return surface_.height; }
  const CompliantBody& body() const { return body_; }
  // Of the surface, for the gaps between patches in contact.
  const SurfaceLevels& levels() const { return levels_; }
  const Texture& described() const { return texture_; }

  // Skin k of the fidelity: common to every design, because its modes are keyed by integer index.
  Heightmap skin(int k) const;
  // Texture + skin [m].
  std::vector<double> height(const Heightmap& skin) const;
  // Low and high volume (or the mean) by droplet seeds, on skin k.
  std::vector<WaterMember> water_members(int k) const;

  // The problem points into this setup and at height and kernel.
  PatchProblem problem(std::span<const double> height, const ContactKernel& kernel,
                       double relative_humidity, double pressure, const WaterMember& water) const;

 private:
  Scene scene_;
  Fidelity fidelity_;
  Texture texture_;
  Plan plan_;
  CoveredSurface surface_;
  CompliantBody body_;
  SurfaceLevels levels_;
};

}  // namespace papilla::forward
