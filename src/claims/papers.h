// The claims by paper and subject: what the .cpp files of this folder give to the one list.
#pragma once

#include <cmath>
#include <string>
#include <vector>

#include "base/rooms.h"
#include "claims/claim.h"
#include "published/samples.h"

namespace papilla::claims {

// Relative difference.
inline double off_by(double a, double b) { return std::abs(a / b - 1); }

// The M3 paper simulated every volume of water so often, with the droplets elsewhere.
inline constexpr int kPlacements = 6;

// Of a number over patches: where its sign or its band is what the paper says.
Part above_zero(std::string name, const SkinEstimate& e);
Part below_zero(std::string name, const SkinEstimate& e);
Part in_band(std::string name, const SkinEstimate& e, double low, double high);

// M: the M3 model (Ma et al. 2025).
Claim m3_claim(const char* id, const char* statement, const char* band,
               std::function<Judgement(FingerModel&)> judge);
std::vector<Claim> m3_friction_claims();    // friction and contact area
std::vector<Claim> m3_modulation_claims();  // the effect of the field, by texture and humidity
std::vector<Claim> m3_water_claims();       // capillary forces, bridges, contact angle
std::vector<Claim> m3_field_claims();       // electrostatic pull, its fields, van der Waals
std::vector<Claim> m3_film_claims();        // films of particles
// The theory papers, each judged by the numbers that it prints, and no others.
std::vector<Claim> mean_field_claims();  // P: mean-field electroadhesion
std::vector<Claim> network_claims();     // J, B: Johnsen-Rahbek, broadband drive
std::vector<Claim> stiction_claims();    // S: stiction rendering

}  // namespace papilla::claims
