#include "design/words.h"

namespace papilla::design {

const std::vector<Word>& words() {
  static const std::vector<Word> list{
      {"voltage", "drive.amplitude"},
      {"volts", "drive.amplitude"},
      {"bias", "drive.amplitude"},
      {"amperage", "drive.current"},
      {"signal", "drive.waveform"},
      {"stiffness", "finger.skin.layer_modulus"},
      {"stiffness", "surface.modulus"},
      {"elastic_modulus", "finger.skin.layer_modulus"},
      {"elastic_modulus", "surface.modulus"},
      {"youngs_modulus", "finger.skin.layer_modulus"},
      {"youngs_modulus", "surface.modulus"},
      {"young", "finger.skin.layer_modulus"},
      {"young", "surface.modulus"},
      {"roughness", "texture.rms"},
      {"roughness", "finger.skin.rms"},
      {"sq", "texture.rms"},
      {"rq", "texture.rms"},
      {"sq", "finger.skin.rms"},
      {"rq", "finger.skin.rms"},
      {"pitch", "texture.period"},
      {"spacing", "texture.period"},
      {"lattice_constant", "texture.period"},
      {"sidewall", "texture.wall_angle"},
      {"fillet", "texture.edge_radius"},
      {"rounding", "texture.edge_radius"},
      {"density", "texture.coverage"},
      {"fill", "texture.coverage"},
      {"oxide", "surface.dielectric"},
      {"insulator", "surface.dielectric"},
      {"coating", "surface.dielectric"},
      {"thickness", "surface.dielectric.0.thickness"},
      {"wetting", "surface.contact_angle"},
      {"wettability", "surface.contact_angle"},
      {"index", "surface.refractive_index"},
      {"force", "finger.load"},
      {"normal_force", "finger.load"},
      {"pressure", "finger.load"},
      {"friction_coefficient", "finger.macro.shear_strength"},
      {"shear", "finger.macro.shear_strength"},
      {"sweat", "finger.water.volume"},
      {"moisture", "finger.water.volume"},
      {"humidity", "environment.relative_humidity"},
      {"rh", "environment.relative_humidity"},
      {"bounds", "design_space"},
      {"variables", "design_space"},
      {"parameters", "design_space"},
      {"goal", "objective"},
      {"goals", "objective"},
      {"cost", "objective"},
      {"limits", "constraints"},
      {"tolerance", "scatter"},
      {"tolerances", "scatter"},
      {"users", "population"},
      {"optimizer", "search.method"},
      {"optimiser", "search.method"},
      {"algorithm", "search.method"},
      {"budget", "search.evaluations"},
      {"iterations", "search.evaluations"},
      {"timeout", "search.time"},
      {"threads", "search.jobs"},
  };
  return list;
}

std::string key_for_word(const std::string& word, const std::string& section) {
  std::string found;
  for (const Word& w : words()) {
    if (w.word != word) continue;
    if (!section.empty() && w.key.starts_with(section + ".")) return w.key;
    if (found.empty()) found = w.key;
  }
  return found;
}

}  // namespace papilla::design
