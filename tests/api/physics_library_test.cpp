// Single pieces of the physics through the library: closed forms, and the borders of what it takes.
#include <gtest/gtest.h>
#include <papilla/papilla.h>

#include <algorithm>
#include <cmath>
#include <functional>
#include <numeric>
#include <string>
#include <vector>

namespace {

constexpr double kPi = 3.14159265358979323846, kEps0 = 8.8541878128e-12;

papilla::Heights plane(double z, int n = 16) {
  return {n, n, 1e-7, 1e-7, std::vector<double>(static_cast<std::size_t>(n) * n, z)};
}

// What the library says of it; "" where it takes it.
std::string refusal(const std::function<void()>& call) {
  try {
    call();
  } catch (const papilla::InputError& error) {
    return error.what();
  }
  return "";
}

TEST(FieldOfTheLibrary, OfAPlaneGapIsThatOfACapacitor) {
  papilla::FieldOptions options;
  options.thickness = 800e-9, options.permittivity = 4, options.skin_layer = 50e-9;
  const double total = 150e-9 + 200e-9 + 50e-9, volts = 20;
  const double field = volts / total, pull = 0.5 * kEps0 * field * field;
  for (const bool dc : {false, true}) {
    options.dc = dc;
    for (const auto method :
         {papilla::FieldMethod::Local, papilla::FieldMethod::Spread, papilla::FieldMethod::Full}) {
      options.method = method;
      const papilla::FieldResult r = papilla::field(plane(150e-9), volts, options);
      ASSERT_TRUE(r.converged) << r.reason;
      const double expected = dc ? pull : pull / 2;  // of a sine the mean square is half
      EXPECT_NEAR(r.mean_pressure, expected, 2e-3 * expected);
      EXPECT_NEAR(r.force, r.mean_pressure * 1.6e-6 * 1.6e-6, 1e-9 * r.force);
      ASSERT_EQ(r.pressure.size(), 256u);
      EXPECT_NEAR(std::accumulate(r.pressure.begin(), r.pressure.end(), 0.0) / 256, r.mean_pressure,
                  1e-9 * expected);
      EXPECT_NEAR(r.peak_air_field, field, 2e-3 * field);  // at the peak of either
      EXPECT_NEAR(r.peak_oxide_field, field / 4, 2e-3 * field);
    }
  }
  EXPECT_EQ(papilla::field(plane(150e-9), 0, options).force, 0);
}

// A film that follows the walls of the surface below: over a flat one it is the film itself.
TEST(FieldOfTheLibrary, OverAFlatSurfaceIsThatOfItsFilm) {
  papilla::FieldOptions options;
  options.thickness = 300e-9, options.permittivity = 3, options.dc = true;
  options.method = papilla::FieldMethod::Local;
  const papilla::Heights gap = plane(100e-9), surface = plane(0);
  const double expected = 0.5 * kEps0 * std::pow(10 / 200e-9, 2);
  EXPECT_NEAR(papilla::field(gap, 10, options, &surface).mean_pressure, expected, 1e-6 * expected);
  papilla::Heights other = plane(0, 32);
  EXPECT_EQ(refusal([&] { papilla::field(gap, 10, options, &other); }),
            "surface: must have the pixels and the size of the gap");
}

TEST(FieldOfTheLibrary, TakesWhatHasAMeaning) {
  const auto said = [](double volts, const std::function<void(papilla::FieldOptions&)>& change,
                       const papilla::Heights& gap = plane(1e-7)) {
    papilla::FieldOptions options;
    options.method = papilla::FieldMethod::Local;
    change(options);
    return refusal([&] { papilla::field(gap, volts, options); });
  };
  const auto as_is = [](papilla::FieldOptions&) {};
  EXPECT_EQ(said(0, as_is), "");
  EXPECT_EQ(said(-1e-6, as_is), "voltage: must not be negative");
  EXPECT_EQ(said(1, [](auto& o) { o.thickness = 0; }), "");
  EXPECT_EQ(said(1, [](auto& o) { o.thickness = -1e-12; }), "thickness: must not be negative");
  EXPECT_EQ(said(1, [](auto& o) { o.permittivity = 1; }), "");
  EXPECT_EQ(said(1, [](auto& o) { o.permittivity = 0.999; }), "permittivity: is 1 or more");
  EXPECT_EQ(said(1, [](auto& o) { o.skin_layer = -1e-12; }), "skin_layer: must not be negative");
  EXPECT_EQ(said(1, [](auto& o) { o.edge_radius = 1e-9; }), "");
  EXPECT_EQ(said(1, [](auto& o) { o.edge_radius = -1e-12; }), "edge_radius: must not be negative");
  EXPECT_EQ(said(1, as_is, plane(0)), "");
  EXPECT_EQ(said(1, as_is, plane(-1e-12)),
            "gap: must not be negative anywhere; it is 0 in contact");
  const std::string shape = "heights: expected nx times ny values and pixels above 0 m";
  papilla::Heights wrong = plane(1e-7);
  wrong.z.pop_back();
  EXPECT_EQ(said(1, as_is, wrong), shape);
  for (double papilla::Heights::*pixel : {&papilla::Heights::dx, &papilla::Heights::dy}) {
    for (const double size : {0.0, -1e-7}) {
      wrong = plane(1e-7);
      wrong.*pixel = size;
      EXPECT_EQ(said(1, as_is, wrong), shape);
    }
  }
  EXPECT_EQ(said(1, as_is, {0, 0, 1e-7, 1e-7, {}}), shape);
  EXPECT_EQ(said(1, as_is, {1, 1, 1e-7, 1e-7, {1e-7}}), "");
}

// A sine of amplitude a, fully in contact: pressure p + p* cos, p* = E k a / 2, energy E k a^2 / 8
// of the area; the mean planes approach by a from first touch on.
TEST(ContactOfTheLibrary, OfASineInFullContactIsWestergaards) {
  const int n = 32;
  const double length = n * 1e-7, k = 2 * kPi / length, a = 5e-9, modulus = 2e6;
  papilla::Heights wave{n, n, 1e-7, 1e-7, {}};
  for (int i = 0; i < n * n; ++i) wave.z.push_back(a * std::cos(k * 1e-7 * (i % n)));
  const double crest = 0.5 * modulus * k * a, load = 1.5 * crest;
  const papilla::ContactResult r =
      papilla::contact(wave, papilla::Solid::half_space(modulus), load);
  ASSERT_TRUE(r.converged) << r.reason;
  EXPECT_NEAR(r.area_fraction, 1, 1e-12);
  EXPECT_NEAR(r.mean_pressure, load, 1e-6 * load);
  EXPECT_NEAR(r.approach, a, 1e-5 * a);
  EXPECT_NEAR(r.elastic_energy, modulus * k * a * a / 8 * length * length, 1e-5 * r.elastic_energy);
  EXPECT_NEAR(*std::max_element(r.pressure.begin(), r.pressure.end()), 2.5 * crest, 1e-4 * crest);
  EXPECT_NEAR(*std::min_element(r.pressure.begin(), r.pressure.end()), 0.5 * crest, 1e-4 * crest);
  EXPECT_NEAR(*std::max_element(r.gap.begin(), r.gap.end()), 0, 1e-6 * a);
  EXPECT_LE(r.certificate, 1e-8);
  // A layer as stiff as what is below it is none; a thin one is what is below it, a thick one
  // itself. By E / (1 - nu^2).
  const auto crest_of = [&](const papilla::Solid& solid) {
    const auto p = papilla::contact(wave, solid, load).pressure;
    return *std::max_element(p.begin(), p.end()) - load;
  };
  EXPECT_NEAR(crest_of({modulus * 0.91, 0.3, 2e-7, modulus * 0.91, 0.3}), crest, 1e-3 * crest);
  EXPECT_NEAR(crest_of({modulus * 0.4, 0.4, 1e-12, modulus * 0.84, 0.4}), crest, 2e-3 * crest);
  EXPECT_NEAR(crest_of({modulus * 0.96, 0.2, 1e-4, modulus * 0.7, 0.45}), crest, 2e-2 * crest);
  EXPECT_NEAR(crest_of({7, 0.1, 0, modulus * 0.75, 0.5}), crest, 1e-3 * crest);
}

TEST(ContactOfTheLibrary, UnderACapOfPressureCarriesItsLoadOnMoreArea) {
  papilla::Heights wave{16, 16, 1e-7, 1e-7, {}};
  for (int i = 0; i < 256; ++i) wave.z.push_back(5e-8 * std::cos(2 * kPi * (i % 16) / 16.0));
  const papilla::Solid solid = papilla::Solid::half_space(1e6);
  const papilla::ContactResult soft = papilla::contact(wave, solid, 1e4, 1e-6, 3e4),
                               free = papilla::contact(wave, solid, 1e4, 1e-6);
  ASSERT_TRUE(soft.converged && free.converged) << soft.reason << free.reason;
  EXPECT_NEAR(*std::max_element(soft.pressure.begin(), soft.pressure.end()), 3e4, 1);
  EXPECT_GT(*std::max_element(free.pressure.begin(), free.pressure.end()), 3.1e4);
  EXPECT_GT(soft.area_fraction, free.area_fraction);
  EXPECT_GE(soft.area_fraction, 1.0 / 3 - 0.05);
  EXPECT_GT(soft.area_fraction_error, 0);
}

TEST(ContactOfTheLibrary, TakesWhatHasAMeaning) {
  const auto said = [](double modulus, double pressure, double tolerance, double hardness,
                       double bulk = 0) {
    papilla::Solid solid = papilla::Solid::half_space(modulus);
    if (bulk != 0) solid.bulk_modulus = bulk;
    return refusal([&] { papilla::contact(plane(0), solid, pressure, tolerance, hardness); });
  };
  EXPECT_EQ(said(1e6, 1e4, 1e-6, 0), "");
  EXPECT_EQ(said(1e6, 0, 1e-6, 0), "");
  EXPECT_EQ(said(1e6, -1e-3, 1e-6, 0), "mean_pressure: must not be negative");
  EXPECT_EQ(said(1e6, 1e8, 1e-6, 0), "");  // a hundred times
  EXPECT_EQ(said(1e6, 1.001e8, 1e-6, 0), "mean_pressure: is more than 100 times the modulus");
  EXPECT_EQ(said(1e6, 1.001e8, 1e-6, 0, 1.1e6), "");  // of the stiffer one
  EXPECT_EQ(said(1e6, 0, 1e-6, 0, -1), "modulus: must be positive");
  EXPECT_EQ(said(0, 0, 1e-6, 0, 1e6), "modulus: must be positive");
  EXPECT_EQ(said(1e6, 1e4, 1e-6, -1), "hardness: must not be negative");
  EXPECT_EQ(said(1e6, 1e4, 0, 0), "tolerance: is above 0, at most 0.1");
  EXPECT_EQ(said(1e6, 1e4, 0.1, 0), "");
  EXPECT_EQ(said(1e6, 1e4, 0.1001, 0), "tolerance: is above 0, at most 0.1");
}

// Between plates at right angles water is a cylinder, r^2 = V / (pi h): it presses with sigma / r
// and pulls with 2 pi r sigma - pi r^2 sigma / r.
TEST(BridgeOfTheLibrary, AtRightAnglesIsACylinder) {
  const double volume = 2e-20, gap = 150e-9, sigma = 0.07;
  const double r = std::sqrt(volume / (kPi * gap));
  const papilla::BridgeResult b = papilla::bridge(volume, gap, kPi / 2, kPi / 2, sigma);
  ASSERT_TRUE(b.exists) << b.reason;
  EXPECT_NEAR(b.radius1, r, 1e-6 * r);
  EXPECT_NEAR(b.radius2, r, 1e-6 * r);
  EXPECT_NEAR(b.pressure, sigma / r, 1e-5 * sigma / r);
  EXPECT_NEAR(b.force, kPi * r * sigma, 1e-5 * kPi * r * sigma);
  EXPECT_NEAR(b.energy, 2 * kPi * r * gap * sigma, 1e-5 * 2 * kPi * r * gap * sigma);
  // It is stable up to a height of half its girth: h = pi r, so h^3 = pi V.
  EXPECT_NEAR(b.rupture_gap, std::cbrt(kPi * volume), 1e-3 * b.rupture_gap);
  const papilla::BridgeResult large = papilla::bridge(8 * volume, gap, kPi / 2, kPi / 2, sigma);
  EXPECT_NEAR(large.rupture_gap, 2 * b.rupture_gap, 1e-9 * b.rupture_gap);
}

TEST(BridgeOfTheLibrary, SpreadsOnThePlateThatItWets) {
  const papilla::BridgeResult b = papilla::bridge(2e-20, 100e-9, 0.5, 1.4, 0.07),
                              turned = papilla::bridge(2e-20, 100e-9, 1.4, 0.5, 0.07);
  ASSERT_TRUE(b.exists && turned.exists);
  EXPECT_GT(b.radius1, 1.05 * b.radius2);
  EXPECT_NEAR(b.radius1, turned.radius2, 1e-6 * b.radius1);
  EXPECT_NEAR(b.radius2, turned.radius1, 1e-6 * b.radius1);
  EXPECT_NEAR(b.force, turned.force, 1e-5 * std::abs(b.force));
  EXPECT_LT(b.pressure, 0);
  EXPECT_GT(b.force, 0);
  EXPECT_NEAR(papilla::bridge(2e-20, 100e-9, 0.5, 1.4, 0.14).force, 2 * b.force, 1e-5 * b.force);
  EXPECT_EQ(refusal([] { papilla::bridge(-1, 1e-7, 1, 1, 0.07); }),
            "volume, gap and surface tension must be positive, the contact angles 0 to 180 deg");
  const papilla::BridgeResult none = papilla::bridge(2e-20, 1e-5, 0.5, 1.4, 0.07);
  EXPECT_FALSE(none.exists);
  EXPECT_NE(none.reason, b.reason);
}

TEST(DropletsOfTheLibrary, TakeWhatHasAMeaning) {
  const auto said = [](const std::function<void(papilla::Water&)>& change) {
    papilla::Water water;
    change(water);
    return refusal([&] { papilla::droplets(plane(1e-7), 0, water); });
  };
  EXPECT_EQ(said([](auto&) {}), "");
  EXPECT_EQ(said([](auto& w) { w.surface_tension = 0; }), "surface_tension: must be positive");
  for (double papilla::Water::*angle :
       {&papilla::Water::theta_skin, &papilla::Water::theta_substrate}) {
    const std::string why = angle == &papilla::Water::theta_skin ? "theta_skin: is 0 to pi"
                                                                 : "theta_substrate: is 0 to pi";
    EXPECT_EQ(said([&](auto& w) { w.*angle = 0; }), "");
    EXPECT_EQ(said([&](auto& w) { w.*angle = std::acos(-1.0); }), "");
    EXPECT_EQ(said([&](auto& w) { w.*angle = -1e-6; }), why);
    EXPECT_EQ(said([&](auto& w) { w.*angle = kPi + 1e-6; }), why);
  }
  EXPECT_EQ(said([](auto& w) { w.hysteresis = 0; }), "");
  EXPECT_EQ(said([](auto& w) { w.hysteresis = 2; }), "");
  EXPECT_EQ(said([](auto& w) { w.hysteresis = -1e-6; }), "hysteresis: is 0 to 2");
  EXPECT_EQ(said([](auto& w) { w.hysteresis = 2.00001; }), "hysteresis: is 0 to 2");
  const auto with = [](double volume, double drops, double step) {
    papilla::DropletOptions options;
    options.drops_per_volume = drops, options.first_step = step;
    return refusal([&] { papilla::droplets(plane(1e-7), volume, {}, options); });
  };
  EXPECT_EQ(with(0, 1e20, 1e-9), "");
  EXPECT_EQ(with(-1e-30, 1e20, 1e-9), "volume: must not be negative");
  const std::string many = "drops_per_volume: must be positive and give at most a million droplets";
  EXPECT_EQ(with(1e-20, 0, 1e-9), many);
  EXPECT_EQ(with(1e-20, 1.001e26, 1e-9), many);
  EXPECT_EQ(with(1e-20, 1e20, 0), "first_step: must be positive");
}

TEST(DropletsOfTheLibrary, KeepTheirWaterAndFallInEnergy) {
  const papilla::Heights gap = plane(100e-9, 64);  // 6.4 um wide
  papilla::DropletOptions options;
  options.drops_per_volume = 50e18;
  const papilla::DropletsResult r = papilla::droplets(gap, 0.4e-18, {}, options);
  ASSERT_TRUE(r.converged);
  EXPECT_EQ(r.state, papilla::WaterState::Discs);
  ASSERT_GT(r.droplets.size(), 1u);
  EXPECT_LE(r.droplets.size(), 20u);
  double volume = 0, bridged = 0, force = 0;
  int bridges = 0;
  for (const papilla::DropletState& d : r.droplets) {
    volume += d.volume;
    EXPECT_GE(d.x, 0);
    EXPECT_LT(d.x, 6.4e-6);
    EXPECT_GT(d.radius, d.height);
    if (d.place != papilla::DropletPlace::Bridge) continue;
    ++bridges;
    bridged += d.volume;
    force += d.force;
    // A flat disc that fills the gap.
    EXPECT_NEAR(d.height, 100e-9, 1e-12);
    EXPECT_NEAR(d.volume / (kPi * d.radius * d.radius * 100e-9), 1, 0.25);
  }
  EXPECT_GT(bridges, 0);
  EXPECT_NEAR(volume, 0.4e-18, 1e-9 * volume);
  EXPECT_EQ(r.bridges, bridges);
  EXPECT_NEAR(r.bridge_volume, bridged, 1e-9 * bridged);
  EXPECT_NEAR(r.capillary_force, force, 1e-9 * force);
  EXPECT_LE(r.final_energy, r.initial_energy);
  ASSERT_EQ(r.bridged.size(), 64u * 64u);
  const double wet = std::accumulate(r.bridged.begin(), r.bridged.end(), 0.0);
  EXPECT_NEAR(r.wetted_fraction, wet / (64 * 64), 0.02);
  EXPECT_GT(r.retention, 0);
  // Other places by another seed and by another member of its ensemble.
  for (const auto& [seed, index] : {std::pair(2, 0), {1, 1}}) {
    papilla::DropletOptions other = options;
    other.seed = static_cast<std::uint64_t>(seed), other.index = static_cast<std::uint64_t>(index);
    EXPECT_NE(papilla::droplets(gap, 0.4e-18, {}, other).droplets[0].x, r.droplets[0].x);
  }
  EXPECT_EQ(papilla::droplets(gap, 0.4e-18, {}, options).droplets[0].x, r.droplets[0].x);
  // More water than gap; and none.
  EXPECT_EQ(papilla::droplets(gap, 1e-17).state, papilla::WaterState::Flooded);
  const papilla::DropletsResult dry = papilla::droplets(gap, 0);
  EXPECT_EQ(dry.state, papilla::WaterState::Dry);
  EXPECT_EQ(dry.bridged, std::vector<std::uint8_t>(64 * 64, 0));
  // Water at one pressure has no droplets of its own.
  options.threshold = true;
  const papilla::DropletsResult even = papilla::droplets(gap, 0.4e-18, {}, options);
  EXPECT_TRUE(even.droplets.empty());
}

TEST(LookOfTheLibrary, TakesWhatHasAMeaning) {
  const auto said = [](const std::function<void(papilla::LookOptions&)>& change) {
    papilla::LookOptions options;
    change(options);
    return refusal([&] { papilla::look(plane(0), options); });
  };
  EXPECT_EQ(said([](auto& o) { o.index = 1; }), "");
  EXPECT_EQ(said([](auto& o) { o.index = 5; }), "");
  EXPECT_EQ(said([](auto& o) { o.index = 0.999; }), "index: is 1 to 5");
  EXPECT_EQ(said([](auto& o) { o.index = 5.001; }), "index: is 1 to 5");
  EXPECT_EQ(said([](auto& o) { o.fill_index = 1.46; }), "");
  EXPECT_EQ(said([](auto& o) { o.fill_index = 0.999; }),
            "fill_index: is 1 to the index of the glass");
  EXPECT_EQ(said([](auto& o) { o.fill_index = 1.461; }),
            "fill_index: is 1 to the index of the glass");
  const std::string angles = "angles: are 0 to 70 deg, one at least";
  EXPECT_EQ(said([](auto& o) { o.angles = {}; }), angles);
  EXPECT_EQ(said([](auto& o) { o.angles = {0, 70 * kPi / 180}; }), "");
  EXPECT_EQ(said([](auto& o) { o.angles = {0, 70.01 * kPi / 180}; }), angles);
  EXPECT_EQ(said([](auto& o) { o.angles = {-1e-6, 0.1}; }), angles);
}

// A shallow relief scatters by the square of its phase: of its depth and of the step of the index.
TEST(LookOfTheLibrary, OfAShallowReliefGrowsWithTheSquareOfItsPhase) {
  const auto haze = [](double depth, double fill, double angle = 0) {
    papilla::Heights wave{64, 64, 1e-7, 1e-7, {}};
    for (int i = 0; i < 64 * 64; ++i) wave.z.push_back(depth * std::cos(2 * kPi * (i % 64) / 32.0));
    papilla::LookOptions options;
    options.fill_index = fill;
    options.angles = {angle};
    return papilla::look(wave, options).haze;
  };
  EXPECT_GT(haze(4e-9, 1), 0);
  EXPECT_NEAR(haze(8e-9, 1) / haze(4e-9, 1), 4, 0.05);
  EXPECT_NEAR(haze(4e-9, 1.23) / haze(4e-9, 1), 0.25, 0.01);
  EXPECT_GT(std::abs(haze(4e-9, 1, 0.8) / haze(4e-9, 1) - 1), 0.01);
  const papilla::Look flat = papilla::look(plane(0));
  EXPECT_NEAR(flat.haze, 0, 1e-12);
  // Fresnel at 60 deg: of 1.46 over that of 1.567.
  EXPECT_NEAR(flat.gloss, 100 * 0.08245409 / 0.10005603, 1e-4);
}

}  // namespace
