"""What users hand over, and what is said where it is not what it should be."""

import operator

import drjit as dr
import mitsuba as mi

MOST = 2**31 - 1


def whole_number(name, value, least, most=MOST, expected=None):
    """A whole number in a range, which numpy's and Dr.Jit's numbers are as well. Raises TypeError or ValueError."""
    expected = f"odis: {name}: expected {expected or f'a whole number from {least} to {most}'}, found {value}"
    if dr.is_array_v(value) and dr.width(value) == 1 and dr.depth_v(value) == 1:
        value = dr.slice(value)
    try:
        number = operator.index(value)
    except TypeError:
        raise TypeError(expected) from None
    if isinstance(value, bool):
        raise TypeError(expected)
    if not least <= number <= most:
        raise ValueError(expected)
    return number


def of_type(name, value, kind, expected):
    """A value of a type. Raises TypeError."""
    if not isinstance(value, kind):
        raise TypeError(f"odis: {name}: expected {expected}, found {value}")
    return value


def scene(name, value):
    """A mi.Scene. Raises TypeError."""
    makers = {str: "odis.mitsuba.scene_files.load_file loads that of a file", dict: "mi.load_dict makes one of it"}
    if type(value) in makers or not isinstance(value, mi.Scene):
        hint = f"; {makers[type(value)]}" if type(value) in makers else ""
        raise TypeError(f"odis: {name}: expected a mi.Scene, found a {type(value).__name__}{hint}")
    return value


def progress(value):
    if not callable(value):
        raise TypeError(f"odis: progress: expected a function of a number, found {value}")
    return value


def sensor_of(scene, sensor):
    """A sensor of a scene: itself, or its number."""
    if isinstance(sensor, mi.Sensor):
        return sensor
    sensors = scene.sensors()
    if not sensors:
        raise ValueError("odis: sensor: expected a scene with a sensor, found one without")
    return sensors[whole_number("sensor", sensor, -len(sensors), len(sensors) - 1,
                                f"a mi.Sensor or the number of one of the scene's {len(sensors)}")]
