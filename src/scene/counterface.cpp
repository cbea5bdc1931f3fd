#include "scene/counterface.h"

namespace papilla::scene {

void fields(FieldVisitor& v, PinRoughness& s) {
  v.number({"rms", "um", 0, 1e3, "rms height over all wavelengths; 0: smooth"}, s.rms);
  v.number({"longest", "um", 1e-3, 1e6, "longest wavelength", Source::Choice, "none is measured"},
           s.longest);
  v.number({"roll_off", "um", 1e-3, 1e6, "wavelength above which the spectrum is flat",
            Source::Choice, "none is measured"},
           s.roll_off);
  v.number({"hurst", "", 0.01, 1, "Hurst exponent", Source::Estimate, "machined and worn faces"},
           s.hurst);
  v.number({"cutoff", "nm", 1, 1e6, "shortest wavelength", Source::Choice, "as for skin"},
           s.cutoff);
  v.path({"map", "measured topography instead of the spectrum (heightmap file)"}, s.map);
  v.number({"map_width", "um", 0, 1e6, "lateral width of the map where the file has none"},
           s.map_width);
}

void fields(FieldVisitor& v, Pin& s) {
  v.text({"name", "name of the body"}, s.name);
  v.number({"load", "N", 0, 1e4, "normal force"}, s.load);
  v.number({"modulus", "GPa", 0, 1e4, "Young's modulus"}, s.modulus);
  v.number({"poisson", "", 0, 0.5, "Poisson ratio", Source::Estimate, "metals and polymers"},
           s.poisson);
  v.number({"hardness", "GPa", 0, 1e3, "cap on the contact pressure; 0: none"}, s.hardness);
  v.choice({"face", "a sphere of a radius, or a flat of an area"}, {"sphere", "flat"}, s.face);
  v.number({"radius", "mm", 0, 1e4, "of the sphere"}, s.radius);
  v.number({"area", "mm2", 0, 1e6, "of the flat face"}, s.area);
  v.section({"roughness", "of the face"}, s.roughness);
  v.number({"shear_strength", "MPa", 0, 1e4, "of true contact: friction is this times the area"},
           s.shear_strength);
  v.number({"coefficient", "", 0, 10, "or of friction: times load, pull and menisci together"},
           s.coefficient);
  v.flag({"conducting", "it is the counter electrode of the drive; else no field reaches it"},
         s.conducting);
  v.number({"water", "um3", 0, 1e6, "in a 12 x 12 um patch, at every humidity; 0: dry"}, s.water);
  v.number({"contact_angle", "deg", 0, 180, "of water on it", Source::Estimate, "metals, polymers"},
           s.contact_angle);
}

std::vector<PinProblem> pin_problems(const Pin& pin) {
  std::vector<PinProblem> out;
  if (pin.load <= 0) out.push_back({"load", "expected a force above 0 N"});
  if (pin.modulus <= 0)
    out.push_back({"modulus", "expected its Young's modulus, e.g. \"3 GPa\": it has no default"});
  const bool sphere = pin.face == PinFace::Sphere;
  if (sphere && pin.radius <= 0)
    out.push_back({"radius", "expected the radius of the sphere, e.g. \"0.7 mm\""});
  if (!sphere && pin.area <= 0)
    out.push_back({"area", "expected the area of the flat face, e.g. \"2 mm2\""});
  if (pin.radius > 0 && pin.area > 0)
    out.push_back({"face", "both a radius and an area are given: a face is a sphere or flat"});
  if ((pin.shear_strength > 0) == (pin.coefficient > 0))
    out.push_back({pin.coefficient > 0 ? "coefficient" : "shear_strength",
                   "expected one law of friction: a shear strength or a coefficient"});
  const PinRoughness& r = pin.roughness;
  if (r.map.empty() && r.rms > 0 && !(r.cutoff < r.roll_off && r.roll_off <= r.longest))
    out.push_back({"roughness.roll_off", "expected cutoff < roll_off <= longest"});
  return out;
}

const Pin* Counterface::in_place() const {
  if (type == CounterfaceType::Finger) return nullptr;
  return type == CounterfaceType::Pin ? &pin : &pen;
}

void fields(FieldVisitor& v, Counterface& s) {
  v.choice({"type",
            "what touches the surface: the finger of [finger]; a pin, by the keys here; the pen of "
            "[counterface.pen]"},
           {"finger", "pin", "pen"}, s.type);
  fields(v, s.pin);
  v.section({"pen", "a second pin, which studies judge beside the first: \"mean(pen.friction)\""},
            s.pen);
}

}  // namespace papilla::scene
