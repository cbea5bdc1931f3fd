// The quantities of an evaluation, listed once: the model fills them at each humidity, and the JSON
// of `papilla evaluate`, C++ and Python offer them under the names of this table. What each is made
// of and which errors it has: src/forward/patch_result.h.
#pragma once

#include <array>

namespace papilla::api {

// Number: a value with its errors, papilla::Quantity to other programs. Unit and meaning of each
// stand in the table below.
template <class Number>
struct Quantities {
  Number friction_off, friction_on, modulation;
  Number area_fraction_off, area_fraction_on;
  Number capillary_force, electrostatic_force, retention_force;
  Number bridges, wetted_fraction;
  Number mean_gap, indentation;

  bool operator==(const Quantities&) const = default;
};

// The state of the finger that a quantity describes: without that state it has no value.
enum class FingerDrive {
  Any,         // known before the drive is applied
  Off,         // a state without a drive, short of full contact
  On,          // a driven state; none of an undriven design
  OnElseZero,  // the same, and 0 for an undriven design
};

template <class Number>
struct QuantityRow {
  Number Quantities<Number>::*value;
  const char* name;  // of the member, in C++ and Python
  const char* key;   // in the JSON of `papilla evaluate`
  const char* unit;  // SI; "" of shares and counts
  FingerDrive drive;
  const char* doc;
};

// In the order of the JSON. A member without a row does not compile.
template <class Number>
inline constexpr std::array kQuantities{
    QuantityRow<Number>{&Quantities<Number>::friction_off, "friction_off", "F_off", "N",
                        FingerDrive::Off, "friction of the finger, drive off"},
    QuantityRow<Number>{&Quantities<Number>::friction_on, "friction_on", "F_on", "N",
                        FingerDrive::On, "friction of the finger, drive on"},
    QuantityRow<Number>{&Quantities<Number>::modulation, "modulation", "modulation", "",
                        FingerDrive::On, "(F_on - F_off) / F_off"},
    QuantityRow<Number>{&Quantities<Number>::area_fraction_off, "area_fraction_off",
                        "area_fraction_off", "", FingerDrive::Off,
                        "contact fraction of the load-carrying patches, drive off"},
    QuantityRow<Number>{&Quantities<Number>::area_fraction_on, "area_fraction_on",
                        "area_fraction_on", "", FingerDrive::On,
                        "contact fraction of the load-carrying patches, drive on"},
    QuantityRow<Number>{&Quantities<Number>::capillary_force, "capillary_force", "capillary_force",
                        "N", FingerDrive::Any,
                        "capillary force on the finger, drive off; negative: it pushes off"},
    QuantityRow<Number>{&Quantities<Number>::electrostatic_force, "electrostatic_force",
                        "electrostatic_force", "N", FingerDrive::OnElseZero,
                        "pull of the field on the finger"},
    QuantityRow<Number>{&Quantities<Number>::retention_force, "retention_force", "retention_force",
                        "N", FingerDrive::Any, "lateral force of contact-angle hysteresis"},
    QuantityRow<Number>{&Quantities<Number>::bridges, "bridges", "bridges", "", FingerDrive::Any,
                        "capillary bridges per patch"},
    QuantityRow<Number>{&Quantities<Number>::wetted_fraction, "wetted_fraction", "wetted_fraction",
                        "", FingerDrive::Any, "bridged share of the patch"},
    QuantityRow<Number>{&Quantities<Number>::mean_gap, "mean_gap", "mean_gap", "m",
                        FingerDrive::Any, "mean gap of the patch"},
    QuantityRow<Number>{&Quantities<Number>::indentation, "indentation", "indentation", "m",
                        FingerDrive::Any, "approach of skin and surface since first touch"}};
static_assert(sizeof(Quantities<double>) == kQuantities<double>.size() * sizeof(double),
              "every quantity has a row");

}  // namespace papilla::api
