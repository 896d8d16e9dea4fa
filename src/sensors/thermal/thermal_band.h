#pragma once
// Black bodies in 8 … 14 µm.

namespace gloam {

/// Radiance of a black body in 8 … 14 µm [W/(m² sr)]: Planck's law integrated by the series of
/// Chang and Rhee 1984, "Blackbody radiation functions". `temperature` [K] in 0 … 6000.
double thermal_radiance(double temperature);

/// The temperature of a black body of that radiance [K]: the inverse, within 2e-4 K from 20 K on, 0
/// … 6000.
double apparent_temperature(double radiance);

}  // namespace gloam
