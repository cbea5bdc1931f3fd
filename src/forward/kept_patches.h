// What of the patches before still holds when a key of the scene moves: for answers under the hand.
#pragma once

#include <optional>
#include <vector>

#include "base/rooms.h"
#include "forward/coupling.h"
#include "forward/patch_set.h"
#include "forward/patch_setup.h"
#include "geometry/measured_map.h"

namespace papilla::forward {

// Of the last run with the load estimator, patch by patch: the dry contact, the water on it.
// A new scene takes over
//   contact and water   where only the drive or the dielectric film moves,
//   contact             where the surface's contact angle moves too,
//   nothing             where anything else does: texture, finger, humidities, model, fidelity.
// The numbers are those of a run that keeps nothing, to the last bit. Memory: 32 bytes per pixel,
// skin, humidity and patch pressure. Not for several threads at once.
class KeptPatches {
 public:
  struct Skin {
    bool contact = false, water = false;  // still hold
    std::vector<double> height;           // texture and skin [m]
    std::vector<UndrivenPatch> patches;   // in the order of a run
  };
  enum class Held { Nothing, Contact, Water };

  // As solve_patches with the load estimator.
  PatchSet solve(const Scene& scene, const Texture& texture, const Fidelity& fidelity,
                 const std::vector<LoadLaws>& laws = {});
  Held held() const { return held_; }  // by the run that began last

  // Of a run: before it, on skin k, after it. One that was stopped leaves nothing.
  void begin(const PatchSetup& setup);
  void end() { whole_ = true; }
  Skin& skin(int k) { return skins_[static_cast<std::size_t>(k)]; }

 private:
  struct Key {
    Scene scene;  // without what does not count
    Texture texture;
    Fidelity fidelity;
    std::vector<MapVersion> maps;  // of texture and skin

    bool operator==(const Key&) const = default;
  };

  std::optional<Key> contact_, water_;
  std::vector<Skin> skins_;
  Held held_ = Held::Nothing;
  bool whole_ = false;  // the last run came to its end
};

}  // namespace papilla::forward
