"""A Taylor bar by another method: axisymmetric finite elements (four-node quadrilaterals of one point with hourglass viscosity,
moving with the material), with the elastic and Johnson-Cook constants of the same library material. What this and the particles
have in common is the material only."""
import pathlib
import re

import numpy as np

LENGTH, RADIUS = 25.4e-3, 3.81e-3
MATERIAL = pathlib.Path("input/materials/COPPER_OFHC.nml")


def constants(changes):
    """The numbers of the material; changes: 'jc_a=157e6' and the like."""
    found = dict(re.findall(r"^\s*(\w+)\s*=\s*([0-9.eE+-]+)", MATERIAL.read_text(), re.MULTILINE))
    found.update(change.split("=") for change in changes)
    return {key: float(value) for key, value in found.items()}


def flow_stress(m, strain, rate, heat):
    """Johnson & Cook; heat: temperature over the reference."""
    hot = np.clip(heat / (m["melt_temperature"] - m["reference_temperature"]), 0, 1)
    return ((m["jc_a"] + m["jc_b"] * strain ** m["jc_n"]) * (1 + m["jc_c"] * np.log(np.maximum(rate / m["reference_strain_rate"], 1)))
            * (1 - hot ** m["jc_m"]))


def impact(velocity, across=15, changes=(), end=100e-6):
    """Node positions (axial, radial) of a bar at the end, on across x along elements."""
    m = constants(changes)
    along = int(round(across * LENGTH / RADIUS))
    r, z = np.meshgrid(np.linspace(0, RADIUS, across + 1), np.linspace(0, LENGTH, along + 1))
    x = np.stack([r, z], axis=-1)
    v = np.zeros_like(x)
    v[..., 1] = -velocity
    density, shear = m["density"], m["youngs_modulus"] / (2 * (1 + m["poissons_ratio"]))
    bulk = m["youngs_modulus"] / (3 * (1 - 2 * m["poissons_ratio"]))
    sound = np.sqrt((bulk + 4 * shear / 3) / density)
    corners = lambda a: np.stack([a[:-1, :-1], a[:-1, 1:], a[1:, 1:], a[1:, :-1]])  # noqa: E731
    hourglass = np.array([1.0, -1, 1, -1])[:, None, None, None]

    def shape(x):
        """Area, centre radius and the derivatives of the four functions."""
        c = corners(x)
        r, z = c[..., 0], c[..., 1]
        area = 0.5 * ((r[2] - r[0]) * (z[3] - z[1]) + (r[1] - r[3]) * (z[2] - z[0]))
        by_r = 0.5 * np.stack([z[1] - z[3], z[2] - z[0], z[3] - z[1], z[0] - z[2]]) / area
        by_z = 0.5 * np.stack([r[3] - r[1], r[0] - r[2], r[1] - r[3], r[2] - r[0]]) / area
        return area, r.mean(axis=0), by_r, by_z

    def gather(forces):
        """Sum over the elements of a node."""
        total = np.zeros_like(x)
        total[:-1, :-1] += forces[0]
        total[:-1, 1:] += forces[1]
        total[1:, 1:] += forces[2]
        total[1:, :-1] += forces[3]
        return total

    area, middle, by_r, by_z = shape(x)
    first = 2 * np.pi * middle * area
    mass = gather(np.repeat((density * first / 4)[None, ..., None], 4, axis=0) * np.ones(2))
    s = np.zeros((4,) + area.shape)  # deviator: rr, zz, tt, rz
    pressure, viscosity, strain, heat = (np.zeros_like(area) for _ in range(4))
    time, volume = 0.0, first.copy()
    while time < end:
        side = np.sqrt(np.minimum(((by_r ** 2).sum(axis=0)) ** -1, ((by_z ** 2).sum(axis=0)) ** -1)) / 1.5
        dt = 0.4 * (side / sound).min()
        area, middle, by_r, by_z = shape(x)
        weight = 2 * np.pi * middle * area
        total = s.copy()
        total[:3] -= pressure + viscosity
        force = -np.stack([by_r * total[0] + by_z * total[3] + 0.25 * total[2] / middle, by_z * total[1] + by_r * total[3]], axis=-1)
        force = force * weight[..., None]
        mode = (hourglass * corners(v)).sum(axis=0)
        force -= 0.03 * (density * sound * volume / np.sqrt(area))[..., None] * hourglass * mode
        v += dt * gather(force) / mass
        v[:, 0, 0] = 0
        v[0, :, 1] = np.maximum(v[0, :, 1], 0)  # the wall pushes, it does not pull
        area, middle, by_r, by_z = shape(x + 0.5 * dt * v)
        c = corners(v)
        d = dt * np.stack([(by_r * c[..., 0]).sum(axis=0), (by_z * c[..., 1]).sum(axis=0), c[..., 0].mean(axis=0) / middle,
                           0.5 * ((by_z * c[..., 0]).sum(axis=0) + (by_r * c[..., 1]).sum(axis=0))])
        spin = 0.5 * dt * ((by_z * c[..., 0]).sum(axis=0) - (by_r * c[..., 1]).sum(axis=0))
        x += dt * v
        np.maximum(x[0, :, 1], 0, out=x[0, :, 1])
        area, middle, by_r, by_z = shape(x)
        volume = 2 * np.pi * middle * area
        trace = d[:3].sum(axis=0)
        d[:3] -= trace / 3
        s += np.stack([2 * spin * s[3], -2 * spin * s[3], 0 * spin, spin * (s[1] - s[0])]) + 2 * shear * d
        rate = np.sqrt(2 / 3 * ((d[:3] ** 2).sum(axis=0) + 2 * d[3] ** 2)) / dt
        trial = np.sqrt(1.5 * ((s[:3] ** 2).sum(axis=0) + 2 * s[3] ** 2)) + 1e-3
        allowed = np.minimum(flow_stress(m, strain, rate, heat), trial)
        increment = (trial - allowed) / (3 * shear)
        strain += increment
        heat += m["taylor_quinney"] * allowed * increment / (density * m["specific_heat"])
        s *= allowed / trial
        pressure = bulk * (first / volume - 1)
        speed = np.maximum(-trace, 0) * np.sqrt(area) / dt
        viscosity = density * speed * (0.06 * sound + 1.5 * speed)
        time += dt
    return x


def measure_reference(words):
    """words: the velocity in m/s, then the number of elements across the radius, then changes of constants. Prints the figures."""
    velocity = float(words[0])
    across = int(words[1]) if len(words) > 1 else 15
    x = 1e3 * impact(velocity, across, words[2:])
    at = np.interp(0.2 * 1e3 * LENGTH + x[..., 1].min(), x[:, -1, 1], x[:, -1, 0])
    print(f"finite elements, {velocity:.0f} m/s, {across} across: length {np.ptp(x[..., 1]):.2f}, foot diameter "
          f"{2 * x[..., 0].max():.2f}, diameter at 0.2 of the first length {2 * at:.2f} mm")
