// What is known of the contact solve before it runs.
#pragma once

#include <string>

#include "base/rooms.h"
#include "geometry/grid.h"

namespace papilla::contact {

std::string contact_method(double tolerance);  // for people
// Price of one solve on one core of a usual machine [s], to a certificate.
double contact_seconds(const Grid& grid, double tolerance);

// Worst relative error of friction from a contact solve with this certificate: Eq. accuracy.1
double contact_error(double certificate);

}  // namespace papilla::contact
