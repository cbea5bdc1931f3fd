// The claims by paper and subject: what the .cpp files of this folder give to the one list.
#pragma once

#include <vector>

#include "claims/claim.h"

namespace papilla {

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

}  // namespace papilla
