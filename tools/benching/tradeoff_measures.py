"""What the scenes of the trade-off are judged by: functions of the folder of a run."""
import functools

import numpy as np

import shock_helium
import slab
import surface_burst
import taylor
from run_tables import read_columns


def last(column, file="gauges.csv"):
    return lambda folder: read_columns(folder / file)[column][-1]


def largest(column):
    return lambda folder: np.nanmax(read_columns(folder / "gauges.csv")[column])


def arrival(column):
    """Time at which half of the peak is reached."""
    def measure(folder):
        data = read_columns(folder / "gauges.csv")
        half = 0.5 * np.nanmax(data[column])
        rise = int(np.argmax(data[column] >= half))
        return float(np.interp(half, data[column][rise - 1:rise + 1], data["time"][rise - 1:rise + 1]))
    return measure


def blast(gauge):
    """Peak overpressure, arrival and largest impulse at a gauge."""
    return {"peak": largest(f"{gauge}.overpressure"), "arrival": arrival(f"{gauge}.overpressure"), "impulse": largest(f"{gauge}.impulse")}


def burst(distances):
    """Peak overpressure and impulse of the positive phase at scaled distances of a surface burst, and the curves' values."""
    def at(z, column):
        def measure(folder):
            found = [row[column] for row in surface_burst.points(folder) if abs(row[0] / z - 1) < 0.01]
            return found[0] if found else np.nan
        return measure
    columns = {"peak": ("pressure", 1), "impulse": ("impulse", 2)}
    measures = {f"{name}, Z = {z:g}": at(z, column) for name, (_, column) in columns.items() for z in distances}
    curves = {f"{name}, Z = {z:g}": surface_burst.curve(quantity, z) for name, (quantity, _) in columns.items() for z in distances}
    return measures, curves


@functools.lru_cache(maxsize=1)
def course(folder):
    return shock_helium.Course(folder)


def bubble(names):
    """Speeds [m/s] of features of the shock and the helium bubble."""
    def speed(name):
        feature, window, span = next(row[1:4] for row in shock_helium.TABLE if row[0] == name)
        return lambda folder: course(folder).speed(feature, window, span)[0]
    return {name: speed(name) for name in names}


def bar(quantity):
    """Length, foot or fifth (the diameter at 0.2 of the first length) [mm] of a Taylor bar."""
    return lambda folder: taylor.shape(folder)[quantity]


def slab_deflection(folder):
    """First peak of the displacement [m] of the front face."""
    return next(deflection.value for deflection in slab.deflections(folder) if deflection.gauge == "centre of the front face")


def slab_spall(folder):
    """Spall radius [m], opening over 8 mm."""
    return slab.spall(folder).extent[0.008][0]
