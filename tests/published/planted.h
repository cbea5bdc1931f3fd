// Samples whose areas stand in the test, in the place of runs: what is read off them can be worked
// out by hand.
#pragma once

#include <fmt/format.h>
#include <gtest/gtest.h>

#include <vector>

#include "base/rooms.h"
#include "published/samples.h"

namespace papilla::tests {

using Numbers = std::vector<std::vector<double>>;  // [humidity][skin]

// The same on two skins, at each humidity: no scatter at all.
inline Numbers on_two_skins(const std::vector<double>& of_humidity) {
  Numbers out;
  for (const double v : of_humidity) out.push_back({v, v});
  return out;
}

// Contact fractions with and without voltage; strength [N] at each humidity, 1 where none is given.
inline Sample planted(const Numbers& off, const Numbers& on,
                      const std::vector<double>& strength = {}) {
  Sample out;
  for (std::size_t rh = 0; rh < off.size(); ++rh) {
    ResponsePoint p;
    p.strength = strength.empty() ? 1 : strength[rh];
    p.samples.area_off = off[rh];
    p.samples.area_on = on[rh];
    out.response.points.push_back(p);
    out.preload.push_back(0);
  }
  return out;
}

// Modulations at each humidity, of areas that are a quarter without voltage.
inline Sample modulated(const Numbers& modulation) {
  Numbers off = modulation, on = modulation;
  for (std::size_t rh = 0; rh < off.size(); ++rh) {
    for (std::size_t k = 0; k < off[rh].size(); ++k) {
      off[rh][k] = 0.25;
      on[rh][k] = 0.25 * (1 + modulation[rh][k]);
    }
  }
  return planted(off, on);
}
inline Sample modulated(const std::vector<double>& modulation) {
  return modulated(on_two_skins(modulation));
}

// What the model keeps first under the words of a case it answers from then on.
inline void plant(FingerModel& model, const SampleCase& c, const Sample& s) {
  const std::string words =
      fmt::format("{} {} {} {}", c.design, c.angle, c.water, static_cast<int>(c.state));
  const Sample& kept = model.once<Sample>(words, [&] { return s; });
  ASSERT_EQ(&sample(model, c), &kept) << words;
}
inline void plant_at_rest(FingerModel& model, const std::string& name, const Sample& s) {
  const Sample& kept = model.once<Sample>("at rest " + name, [&] { return s; });
  ASSERT_EQ(&m3_sample_at_rest(model, name), &kept) << name;
}

}  // namespace papilla::tests
