// Axial force at zero incidence: the coefficients that the build-up adds. Each is on the area its name
// says, for air (ratio of specific heats 1.4).
#pragma once

#include "core/vehicle/mould_line.h"

namespace dispersa {

/// Reynolds number per metre at a Mach number, on a reference ascent through US Standard Atmosphere 1976:
/// Mach 0 at 0 km, 0.3 at 1, 0.8 at 5, 1.2 at 9, 2 at 15, 3 at 22, 5 at 33, 8 and more at 55 km; log-linear
/// between. Skin friction varies as its power -0.15: 3 km of altitude change friction by 6 %.
double ReferenceUnitReynoldsNumber(double mach);

/// Mean skin-friction coefficient of a flat plate, fully turbulent, adiabatic wall, on the wetted area.
///
/// Prandtl-Schlichting 0.455 / (lg Re)^2.58 with the Frankl-Voishel compressibility factor (1 + 0.144
/// M^2)^-0.65. Roughness limits Re: Re <= 38.21 (l/k)^1.053, above Mach 0.88 44.62 (l/k)^1.053 M^1.16
/// (Raymer, Aircraft Design, 12.5.3; DATCOM 4.1.5.1). Range: Re 1e5 to 1e10. A smaller Re counts as 1e5, a
/// Mach number below 0.1 as 0.1. Laminar flow is neglected.
/// @param roughness_m equivalent sand grain k; 0 is smooth.
double SkinFrictionCoefficient(double mach, double length_m, double roughness_m);

/// Pressure drag of a cone, with a corner at its base, on the base area.
///
/// Mach 1 and supersonic values are Hoerner's (Fluid-Dynamic Drag, 16-18 ff.) in the form of Niskanen
/// (OpenRocket technical documentation, 3.4.3). At Mach 1: sin e, with the slope (4/2.4)(1 - sin e / 2). From
/// Mach 1.3: 2.1 sin^2 e + 0.5 sin e / sqrt(M^2 - 1). Between: a cubic. Below Mach 1: a power of Mach that
/// leaves `incompressible` at rest (0.8 sin^2 e with a corner, 0 with a smooth shoulder). Range: half-angle e
/// up to 45 degrees.
double ConePressureDrag(double mach, double sin_half_angle, double incompressible);

/// Pressure drag of a flat face across the stream, on its area: 0.85 of the stagnation pressure
/// (Hoerner 15-2, 16-3).
double FlatFaceDrag(double mach);

/// Base drag of a cut-off cylinder without a jet, on the base area: 0.12 + 0.13 M^2 below Mach 1, 0.25 / M
/// above (Fleeman, Tactical Missile Design; Hoerner 3-12).
double BaseDrag(double mach);

/// Pressure drag of one section times its area, m^2.
///
/// - Cones and widening frustums: the cone of the same angle on the area gained.
/// - Tangent ogives: the cone of the same fineness (Niskanen 3.4.3, shape factor 1), zero at rest.
/// - Boat-tails, by fineness (length over change of diameter): base drag on the area lost below 1, none above
///   3, linear between (Niskanen 3.4.3).
double PressureDragArea(const MouldSection& section, double mach);

}  // namespace dispersa
