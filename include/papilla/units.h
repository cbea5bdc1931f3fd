// Numbers with units, as files and the command line write them.
#pragma once

#include <string>

#include "papilla/names.h"

namespace papilla::api {

// "350 nm" with "m" -> 350e-9: the number in SI, of a text that has the dimension of `unit`. Throws
// InputError.
double in_si(const std::string& text, const std::string& unit);

// 3.5e-7 with "nm" -> "350 nm".
std::string quantity_text(double si, const std::string& unit);

// "nm" -> "m", "deg" -> "rad", "%" -> "": the unit of its numbers in SI. Throws InputError.
std::string si_unit(const std::string& unit);

}  // namespace papilla::api
