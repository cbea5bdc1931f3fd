// What people and programs read of one piece of physics: made-up numbers, each another, in the unit
// that stands beside it.
#include "report/pieces.h"

#include <gtest/gtest.h>

#include "base/constants.h"
#include "report/droplets.h"
#include "tests/report/same_json.h"

namespace papilla::tests::pieces_test {
namespace {

struct Pressed {
  ContactSolution s;
  ContactArea area;
  Heightmap h{{2, 2, 2e-6, 2e-6}, {-1e-7, 5e-8, -2e-7, 0}};

  Pressed() {
    s.status = ContactStatus::Converged;
    s.method = ContactMethod::Sparse;
    s.certificate = 2e-5;
    s.iterations = 7;
    s.fft_pairs = 8.5;
    s.gap = {1e-7, 0, 7e-7, 4e-7};
    s.pressure = {0, 8e5, 0, 0};
    s.shift = 1.5e-7;
    s.elastic_energy = 3e-15;
    area = {.raw = 0.25, .perimeter = 0.2, .near_edge = 0.1234, .se = 0.0056};
  }
};

TEST(SolvedPieces, AContactInNanometresAndKilopascals) {
  const Pressed p;
  EXPECT_EQ(
      contact_text(p.s, p.area, p.h, 0.25),
      "converged: certificate 2e-05 after 7 iterations (sparse), 8.5 transform pairs, 0.25 s\n"
      "contact area      12.3400 ±0.5600 %  (25.0000 % of pixels)\n"
      "mean gap          300 nm\n"
      "mean pressure     200 kPa\n"
      "approach          200 nm\n"
      "largest pressure  0.8 MPa\n"
      "elastic energy    3 fJ\n");
  expect_document(contact_json(p.s, p.area, p.h, 0.25), {{"schema", 1},
                                                         {"converged", true},
                                                         {"reason", "converged"},
                                                         {"method", "sparse"},
                                                         {"certificate", 2e-5},
                                                         {"iterations", 7},
                                                         {"fft_pairs", 8.5},
                                                         {"seconds", 0.25},
                                                         {"area_fraction_raw", 0.25},
                                                         {"area_fraction", 0.1234},
                                                         {"area_fraction_se", 0.0056},
                                                         {"area_fraction_perimeter", 0.2},
                                                         {"mean_pressure", 2e5},
                                                         {"approach", 2e-7},
                                                         {"mean_gap", 3e-7},
                                                         {"max_pressure", 8e5},
                                                         {"elastic_energy", 3e-15}});
  Pressed failed;
  failed.s.status = ContactStatus::IterationLimit;
  EXPECT_EQ(nlohmann::json::parse(contact_json(failed.s, failed.area, failed.h, 0))["reason"],
            "iteration limit");
}

TEST(SolvedPieces, ABridgeWithItsGaps) {
  Bridge bridge;
  bridge.status = BridgeStatus::Converged;
  bridge.energy = 2e-15, bridge.force = 3e-9, bridge.pressure = -4e4;
  bridge.radius1 = 5e-7, bridge.radius2 = 6e-7;
  BridgeLimits limits;
  limits.status = BridgeStatus::Converged;
  limits.rupture = 0.8, limits.switching = 0.7, limits.snap_in = 0.6, limits.zero_force = 0.5;
  EXPECT_EQ(bridge_text(bridge, limits, 1e-7),
            "energy            2 fJ\nforce             3 nN (attracts)\n"
            "Laplace pressure  -40 kPa\nradii             500 and 600 nm\n"
            "ruptures at       80 nm\na droplet above   70 nm (lower energy)\n");
  expect_document(bridge_json(bridge, limits, 1e-7), {{"schema", 1},
                                                      {"exists", true},
                                                      {"reason", text(bridge.status)},
                                                      {"energy", 2e-15},
                                                      {"force", 3e-9},
                                                      {"laplace_pressure", -4e4},
                                                      {"radius1", 5e-7},
                                                      {"radius2", 6e-7},
                                                      {"rupture_gap", 8e-8},
                                                      {"equilibrium_gap", 7e-8},
                                                      {"snap_in_gap", 6e-8},
                                                      {"zero_force_gap", 5e-8}});
  bridge.force = -3e-9;
  limits.switching = limits.zero_force = 0;  // the cap is always lower; attracts at all gaps
  EXPECT_NE(bridge_text(bridge, limits, 1e-7).find("-3 nN (repels)"), std::string::npos);
  EXPECT_EQ(bridge_text(bridge, limits, 1e-7).find("a droplet above"), std::string::npos);
  auto json = nlohmann::json::parse(bridge_json(bridge, limits, 1e-7));
  EXPECT_TRUE(json["equilibrium_gap"].is_null() && json["zero_force_gap"].is_null());
  EXPECT_FALSE(json["rupture_gap"].is_null());
  bridge.status = BridgeStatus::Ruptured;
  limits.status = BridgeStatus::NotConverged;
  EXPECT_EQ(bridge_text(bridge, limits, 1e-7),
            "no bridge: " + std::string(text(BridgeStatus::Ruptured)) +
                "\nruptures at       not found\n");
  limits = {BridgeStatus::Converged};
  EXPECT_NE(bridge_text(bridge, limits, 1e-7).find("no gap has one"), std::string::npos);
  limits = {};
  json = nlohmann::json::parse(bridge_json(bridge, limits, 1e-7));
  for (const char* key : {"energy", "force", "laplace_pressure", "radius1", "radius2",
                          "rupture_gap", "equilibrium_gap", "snap_in_gap", "zero_force_gap"})
    EXPECT_TRUE(json.at(key).is_null()) << key;
}

TEST(SolvedPieces, AFieldAgainstTheStrengthOfItsLayer) {
  FieldSolution s;
  s.mean_pressure = 12500, s.peak_air_field = 40e6, s.peak_oxide_field = 250e6;
  s.over_limit_area = 0.125, s.over_limit_share = 0.25, s.residual = 3e-5, s.iterations = 6;
  FieldRun run{"spread", 1e-8, 1e9, 0.5};
  EXPECT_EQ(field_text(s, run),
            "spread: converged to residual 3e-05 in 6 iterations, 0.5 s\n"
            "mean pressure     12.5 kPa\n"
            "largest field     40 MV/m in air, 250 MV/m in the dielectric (0.25 of its strength)\n"
            "air beyond limit  12.5 % of the area, 25.0 % of the pull\n");
  nlohmann::json expected{{"schema", 1},
                          {"converged", true},
                          {"reason", "converged"},
                          {"method", "spread"},
                          {"mean_pressure", 12500},
                          {"force", 1.25e-4},
                          {"peak_air_field", 40e6},
                          {"peak_oxide_field", 250e6},
                          {"oxide_margin", 4},
                          {"over_limit_area", 0.125},
                          {"over_limit_share", 0.25},
                          {"seconds", 0.5},
                          {"residual", 3e-5},
                          {"iterations", 6}};
  expect_document(field_json(s, run), expected);
  run.method = "local";  // does not iterate
  EXPECT_TRUE(field_text(s, run).starts_with("local: converged, 0.5 s\n"));
  expected.erase("residual"), expected.erase("iterations");
  expected["method"] = "local";
  expect_document(field_json(s, run), expected);
  s.ok = false, s.reason = "no gap", s.peak_oxide_field = 0;
  EXPECT_TRUE(field_text(s, run).starts_with("local: no gap, 0.5 s\n"));
  EXPECT_TRUE(nlohmann::json::parse(field_json(s, run))["oxide_margin"].is_null());
}

TEST(SolvedPieces, ALookInPercentAndDegrees) {
  Optics look;
  look.haze = 0.0123, look.transmittance = 0.917, look.gloss = 85, look.colour_shift = 0.0021;
  look.total_transmittance = 0.92, look.gloss_20 = 70, look.gloss_85 = 95;
  look.distinctness = 0.75, look.sparkle = 0.03;
  look.regime = OpticsRegime::PhaseScreen;
  look.warning = "deep";
  look.spectrum = {{.wavelength = 550e-9,
                    .angle = kPi / 6,
                    .specular = 0.97,
                    .haze = 0.02,
                    .transmitted = 0.9,
                    .total = 0.91,
                    .mirror = 0.8}};
  EXPECT_EQ(optics_text(look),
            "regime         phase screen\n"
            "haze           1.23 %  (ASTM D1003, ISO 14782)\n"
            "transmittance  91.70 %  undeviated; 92.00 % in all (ISO 13468)\n"
            "gloss          85.0 GU at 60 deg, 70.0 at 20, 95.0 at 85 (ISO 2813)\n"
            "distinctness   75.0 %  of the reflected image at 20 deg (after ASTM D5767)\n"
            "sparkle        3.00 %  of the panel's subpixels\n"
            "colour shift   0.0021 (u'v')\n\n"
            "     deg       nm   haze % trans. %  total %\n"
            "      30      550     2.00    90.00    91.00\n"
            "note: deep\n");
  nlohmann::json expected{{"schema", 1},
                          {"regime", "phase screen"},
                          {"warning", "deep"},
                          {"haze", 0.0123},
                          {"transmittance", 0.917},
                          {"total_transmittance", 0.92},
                          {"gloss", 85},
                          {"gloss_20", 70},
                          {"gloss_85", 95},
                          {"distinctness", 0.75},
                          {"sparkle", 0.03},
                          {"colour_shift", 0.0021},
                          {"spectrum",
                           {{{"wavelength", 550e-9},
                             {"angle", kPi / 6},
                             {"specular", 0.97},
                             {"haze", 0.02},
                             {"transmitted", 0.9},
                             {"total", 0.91},
                             {"mirror", 0.8}}}}};
  expect_document(optics_json(look), expected);
  look.regime = OpticsRegime::Refused;
  look.spectrum.clear();
  EXPECT_EQ(optics_text(look), "regime         refused\nnote: deep\n");
  expected["regime"] = "refused";
  expected["spectrum"] = nlohmann::json::array();
  for (const char* key : {"haze", "transmittance", "total_transmittance", "gloss", "gloss_20",
                          "gloss_85", "distinctness", "sparkle", "colour_shift"})
    expected[key] = nullptr;
  expect_document(optics_json(look), expected);
}

struct Settled {
  DropletCase c;
  DropletResult r;

  Settled() {
    c.gap.grid = {10, 5, 4e-6, 2e-6};
    Wetting& w = r.wetting;
    w.status = WettingStatus::Discs;
    w.volume = 8e-20, w.bridge_volume = 2e-20, w.bridges = 3, w.wetted_fraction = 0.0625;
    w.capillary_force = 4e-7, w.retention = 5e-8;
    w.droplets = {{.x = 1e-6,
                   .y = 2e-7,
                   .volume = 3e-20,
                   .state = DropletState::Bridge,
                   .radius = 4e-7,
                   .height = 5e-8,
                   .edge_gap = 6e-8,
                   .force = 7e-9,
                   .energy = 8e-15,
                   .film = 0.25}};
    r.report = {.initial_energy = 9e-15,
                .final_energy = 8.5e-15,
                .initial_droplets = 6,
                .moves = 40,
                .merges = 5,
                .converged = true};
  }
};

TEST(SolvedPieces, DropletsByTheirShareAndPressure) {
  Settled s;
  EXPECT_EQ(droplets_text(s.c, s.r),
            "state            discs\n"
            "water            0.08 um3, 25 % of it in 3 bridges\n"
            "wetted           6.25 % of the patch\n"
            "capillary force  0.4 uN (50 kPa)\n"
            "retention        0.05 uN\n"
            "droplets         1 of 6 left, 40 moves, 5 mergers\n");
  expect_document(droplets_json(s.c, WaterModel::Threshold, s.r, 0.5), {{"schema", 1},
                                                                        {"model", "threshold"},
                                                                        {"status", "discs"},
                                                                        {"converged", true},
                                                                        {"volume", 8e-20},
                                                                        {"bridge_volume", 2e-20},
                                                                        {"bridges", 3},
                                                                        {"wetted_fraction", 0.0625},
                                                                        {"capillary_force", 4e-7},
                                                                        {"capillary_pressure", 5e4},
                                                                        {"retention", 5e-8},
                                                                        {"initial_droplets", 6},
                                                                        {"initial_energy", 9e-15},
                                                                        {"final_energy", 8.5e-15},
                                                                        {"moves", 40},
                                                                        {"merges", 5},
                                                                        {"seconds", 0.5},
                                                                        {"droplets",
                                                                         {{{"x", 1e-6},
                                                                           {"y", 2e-7},
                                                                           {"volume", 3e-20},
                                                                           {"state", "bridge"},
                                                                           {"radius", 4e-7},
                                                                           {"height", 5e-8},
                                                                           {"edge_gap", 6e-8},
                                                                           {"force", 7e-9},
                                                                           {"film", 0.25},
                                                                           {"energy", 8e-15}}}}});
  s.r.wetting = {};  // dry: no share of no water
  s.r.report.converged = false;
  const std::string dry = droplets_text(s.c, s.r);
  EXPECT_NE(dry.find("0 um3, 0 % of it in 0 bridges"), std::string::npos) << dry;
  EXPECT_NE(dry.find("stopped before every droplet was at rest"), std::string::npos) << dry;
}

TEST(SolvedPieces, PlacementsOfDropletsWithTheirErrors) {
  DropletEnsemble e;
  e.placements = 7;
  e.volumes = {{8e-20, {4e-7, 2e-8}, {3, 0.5}, {0.0625, 0.0025}}};
  e.mean_capillary_force = 5e-7;
  EXPECT_EQ(droplet_ensemble_text(e),
            "0.08 um3, 7 placements: capillary force 0.4 ± 0.02 uN, 3 ± 0.5 bridges, "
            "wetted 6.25 ± 0.25 %\nmean             0.5 uN\n");
  expect_document(droplet_ensemble_json(e),
                  {{"schema", 1},
                   {"volumes",
                    {{{"volume", 8e-20},
                      {"capillary_force", {{"value", 4e-7}, {"se", 2e-8}}},
                      {"bridges", {{"value", 3}, {"se", 0.5}}},
                      {"wetted_fraction", {{"value", 0.0625}, {"se", 0.0025}}}}}},
                   {"mean_capillary_force", 5e-7}});
}

}  // namespace
}  // namespace papilla::tests::pieces_test
