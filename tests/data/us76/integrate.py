"""Integrates the equations of the US Standard Atmosphere, 1976, from 86 km to 1000 km, as an oracle.

Number densities of N2, O, O2, Ar, He and H by equations 32 to 40 with the constants of tables 3, 5, 6 and 7;
then mean molecular weight, pressure and density. Python's standard library only.

usage: python3 integrate.py > upper_integrated.csv
"""
from math import exp, sqrt

R = 8314.32          # J/(kmol K)
BOLTZMANN = 1.380622e-23
AVOGADRO = 6.022169e26  # 1/kmol
R0 = 6356766.0
M0 = 28.9644
STEP = 50.0          # m; halving it changes no result by more than 3e-6
BASE, TOP, MIXED_TOP, HYDROGEN_BASE, HYDROGEN_REFERENCE = 86e3, 1000e3, 100e3, 150e3, 500e3

MASS = {"N2": 28.0134, "O": 15.9994, "O2": 31.9988, "Ar": 39.948, "He": 4.0026, "H": 1.00797}
BASE_NUMBER = {"N2": 1.129794e20, "O": 8.6e16, "O2": 3.030898e19, "Ar": 1.351400e18, "He": 7.5817e14}
# Diffusion a (1/(m s)) and b, thermal diffusion, and the flux terms Q, U, W, q, u, w (km).
DIFFUSION = {"O": (6.986e20, 0.750), "O2": (4.863e20, 0.750), "Ar": (4.487e20, 0.870),
             "He": (1.700e21, 0.691), "H": (3.305e21, 0.500)}
THERMAL = {"O": 0.0, "O2": 0.0, "Ar": 0.0, "He": -0.40, "H": -0.25}
FLUX = {"O": (-5.809644e-4, 56.90311, 2.706240e-5, -3.416248e-3, 97.0, 5.008765e-4),
        "O2": (1.366212e-4, 86.0, 8.333333e-5, 0.0, 0.0, 0.0),
        "Ar": (9.434079e-5, 86.0, 8.333333e-5, 0.0, 0.0, 0.0),
        "He": (-2.457369e-4, 86.0, 6.666667e-4, 0.0, 0.0, 0.0)}
HYDROGEN_NUMBER, HYDROGEN_FLUX = 8.0e10, 7.2e11

# Midpoints of the intervals between the tabulated nodes, km.
OUTPUT = [88.5, 92.5, 95.5, 98.5, 101.5, 104.5, 107, 109, 111, 113.5, 117.5, 122.5, 127.5, 132.5, 137.5, 142.5,
          147.5, 152.5, 157.5, 162.5, 167.5, 175, 185, 200, 220, 247.5, 282.5, 325, 375, 425, 475, 525, 575, 625,
          675, 725, 775, 825, 875, 925, 975]


def gravity(z):
    return 9.80665 * (R0 / (R0 + z)) ** 2


def temperature(z):
    km = z / 1e3
    if km <= 91:
        return 186.8673
    if km <= 110:
        return 263.1905 - 76.3232 * sqrt(1 - ((km - 91) / 19.9429) ** 2)
    if km <= 120:
        return 240 + 12 * (km - 110)
    xi = (km - 120) * (6356.766 + 120) / (6356.766 + km)
    return 1000 - 640 * exp(-0.01875 * xi)


def temperature_gradient(z):
    return (temperature(z + 0.5) - temperature(z - 0.5)) if z > 91e3 else 0.0


def eddy_diffusion(z):
    km = z / 1e3
    if km < 95:
        return 120.0
    return 120.0 * exp(1 - 400 / (400 - (km - 95) ** 2)) if km < 115 else 0.0


def flux(species, z):
    km = z / 1e3
    Q, U, W, q, u, w = FLUX[species]
    upper = Q * (km - U) ** 2 * exp(-W * (km - U) ** 3)
    lower = q * (u - km) ** 2 * exp(-w * (u - km) ** 3) if km < u else 0.0
    return (upper + lower) / 1e3


def decay(z, n):
    """-d ln(n T)/dz of each species but hydrogen."""
    g, t, eddy = gravity(z), temperature(z), eddy_diffusion(z)
    rates = {"N2": (M0 if z <= MIXED_TOP else MASS["N2"]) * g / (R * t)}
    for species in FLUX:
        heavy = ("N2",) if species in ("O", "O2") else ("N2", "O", "O2")
        number = sum(n[s] for s in heavy)
        mean = M0 if z <= MIXED_TOP else sum(n[s] * MASS[s] for s in heavy) / number
        a, b = DIFFUSION[species]
        molecular = a / number * (t / 273.15) ** b
        rates[species] = flux(species, z) + g / (R * t) * molecular / (molecular + eddy) * (
            MASS[species] + mean * eddy / molecular + THERMAL[species] * R / g * temperature_gradient(z))
    return rates


def advance(z, n, rates, distance):
    ratio = temperature(z) / temperature(z + distance)
    return {s: n[s] * ratio * exp(-distance * rates[s]) for s in n}


def integrate_from(reference, values):
    """Trapezoidal integral of values, zero at an index."""
    total = [0.0] * len(values)
    for i in range(1, len(values)):
        total[i] = total[i - 1] + 0.5 * STEP * (values[i] + values[i - 1])
    return [x - total[reference] for x in total]


def main():
    altitudes = [BASE + STEP * i for i in range(round((TOP - BASE) / STEP) + 1)]
    profile, n = [], dict(BASE_NUMBER)
    for z in altitudes:
        profile.append(n)
        middle = advance(z, n, decay(z, n), 0.5 * STEP)
        n = advance(z, n, decay(z + 0.5 * STEP, middle), STEP)

    reference = altitudes.index(HYDROGEN_REFERENCE)
    tau = integrate_from(reference, [gravity(z) * MASS["H"] / (R * temperature(z)) for z in altitudes])
    heat = [(temperature(z) / temperature(HYDROGEN_REFERENCE)) ** (1 + THERMAL["H"]) for z in altitudes]
    a, b = DIFFUSION["H"]
    escape = integrate_from(reference, [
        HYDROGEN_FLUX * sum(n.values()) / a * (273.15 / temperature(z)) ** b * h * exp(t)
        for z, n, h, t in zip(altitudes, profile, heat, tau)])
    print("z_geometric_km,T_K,M_kg_kmol,P_Pa,rho_kg_m3")
    for km in OUTPUT:
        i = round((km * 1e3 - BASE) / STEP)
        n = dict(profile[i])
        n["H"] = (HYDROGEN_NUMBER - escape[i]) / heat[i] * exp(-tau[i]) if altitudes[i] >= HYDROGEN_BASE else 0.0
        number = sum(n.values())
        mass = sum(n[s] * MASS[s] for s in n) / number
        t = temperature(altitudes[i])
        print(f"{km},{t:.3f},{mass:.4f},{number * BOLTZMANN * t:.5e},{number * mass / AVOGADRO:.5e}")


if __name__ == "__main__":
    main()
