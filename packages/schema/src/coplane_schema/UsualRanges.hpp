#pragma once

#include <coplane_schema/Schema.hpp>

#include <string>

namespace coplane::usual
{
// Where values lie as a rule, in SI units, and what is behind others most often. One range serves
// all keys of a kind.

inline const std::string ofPressure = "Pascals are meant: 1 GPa is 1e9, 1 MPa 1e6, 1 kPa 1e3.";
inline const std::string ofTangent =
    "The tangent of the angle is meant, not degrees: 31 degrees are 0.6.";
inline const std::string ofFraction = "A fraction is meant, not per cent: 5 % are 0.05.";
inline const std::string ofDensity =
    "kg/m^3 are meant: 1 g/cm^3 and 1 t/m^3 are 1000, 1 t/mm^3 is 1e12.";

inline const UsualRange density{20, 3e4, ofDensity}; ///< of solids and liquids [kg/m^3]
inline const UsualRange gasDensity{0.01, 1e3, ofDensity};
inline const UsualRange modulus{1e6, 3e12, ofPressure};  ///< [Pa]
inline const UsualRange strength{1e3, 1e11, ofPressure}; ///< [Pa]
inline const UsualRange stress{100, 1e13, ofPressure};   ///< [Pa]
inline const UsualRange friction{0.01, 2, ofTangent};    ///< [-]
inline const UsualRange stiffness{1e5, 1e17,             // [Pa/m]
                                  "Pa/m are meant: 1 GPa/m and 1 MPa/mm are 1e9, 1 MPa/m is 1e6."};
inline const UsualRange fractureEnergy{0.5, 1e7, "J/m^2 are meant: 1 N/mm and 1 kJ/m^2 are 1000."};
inline const UsualRange poisson{
    0, 0.495,
    "Almost nothing is left to compress: elements lock and steps are short. "
    "0.49 is enough for nearly incompressible solids."};
inline const UsualRange speed{0, 2e4, "m/s are meant: 1 mm/s is 1e-3, 1 km/s 1000."};
inline const UsualRange acceleration{1e-3, 5e3,
                                     "m/s^2 are meant: the weight on earth is 9.81, not 9810."};
inline const UsualRange temperature{200, 1e4, "Kelvins are meant: 20 degrees Celsius are 293."};
inline const UsualRange fraction{0, 1, ofFraction};
/// Of critical for the surfaces; a body one element high feels less by the root of 2 to 6.
inline const UsualRange contactDamping{0, 2.5, ofFraction};
} // namespace coplane::usual
