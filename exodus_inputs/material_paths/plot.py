#!/usr/bin/env python3
"""Draws the paths of an example deck as one SVG picture, from the CSV files that coplane_point wrote.

Usage: plot.py <name of the deck without .yaml> [folder of the CSV files] [picture]
"""

import importlib.util
import pathlib
import sys

# The pictures are those of the joint paths, with other panels.
_place = pathlib.Path(__file__).resolve().parent.parent / "joint_paths" / "plot.py"
_spec = importlib.util.spec_from_file_location("joint_plot", _place)
plot = importlib.util.module_from_spec(_spec)
_spec.loader.exec_module(plot)

MPA, MILLI = 1e-6, 1e3
AXIAL = ("strain_xx[-]", "stress_xx[Pa]")
AXIAL_TEXT = ("axial strain [1e-3]", "axial stress [MPa]")
PRESSURE = ("volume_ratio[-]", "pressure[Pa]")
PRESSURE_TEXT = ("volume ratio", "pressure [MPa]")
SHEAR = ("strain_xy[-]", "stress_xy[Pa]")
plot.PANELS = {
    "concrete_c40": [
        (
            "Compression", AXIAL, (MILLI, MPA), AXIAL_TEXT,
            [("compression", "0.01 m"), ("compression_large", "0.08 m"), ("uniaxial_strain", "no lateral strain")],
        ),
        ("Tension", AXIAL, (MILLI, MPA), AXIAL_TEXT, [("tension", "")]),
        (
            "Under confinement", AXIAL, (MILLI, MPA), AXIAL_TEXT,
            [("triaxial_5", "5 MPa"), ("triaxial_10", "10 MPa"), ("triaxial_20", "20 MPa")],
        ),
        ("Hydrostat", PRESSURE, (1, MPA), PRESSURE_TEXT, [("hydrostat", ""), ("hydrostat_far", "")]),
    ],
    "concrete_rates": [
        (
            "Tension", AXIAL, (MILLI, MPA), AXIAL_TEXT,
            [("tension_1e-6", "1e-6/s"), ("tension_1", "1/s"), ("tension_10", "10/s")],
        ),
        (
            "Compression", AXIAL, (MILLI, MPA), AXIAL_TEXT,
            [("compression_1e-6", "1e-6/s"), ("compression_1", "1/s"), ("compression_100", "100/s")],
        ),
        ("Fast, at rest, slow, fast", AXIAL, (MILLI, MPA), AXIAL_TEXT, [("stop", "")]),
    ],
    "concrete_hjc": [
        (
            "Compression", AXIAL, (MILLI, MPA), AXIAL_TEXT,
            [("compression", "with damage"), ("compression_intact", "intact"), ("compression_fast", "intact, 1000/s")],
        ),
        ("Hydrostat", PRESSURE, (1, MPA), PRESSURE_TEXT, [("hydrostat", "")]),
    ],
    "concrete_kcc": [
        (
            "Compression", AXIAL, (MILLI, MPA), AXIAL_TEXT,
            [("compression", "free"), ("triaxial_10", "10 MPa"), ("triaxial_50", "50 MPa")],
        ),
        ("Tension", AXIAL, (MILLI, MPA), AXIAL_TEXT, [("tension", "0.01 m"), ("tension_large", "0.1 m")]),
        ("Hydrostat", PRESSURE, (1, MPA), PRESSURE_TEXT, [("hydrostat", "")]),
    ],
    "ceramics": [
        (
            "Crushed by 5 % and back", ("pressure[Pa]", "von_mises[Pa]"), (1e-9, 1e-9), ("pressure [GPa]", "von Mises stress [GPa]"),
            [("case_a", "case A"), ("case_b", "case B"), ("case_c", "case C")],
        ),
        ("Sandstone", AXIAL, (MILLI, MPA), AXIAL_TEXT, [("compression", "free"), ("confined", "25 MPa")]),
    ],
    "metals": [
        (
            "Cycles", AXIAL, (MILLI, MPA), AXIAL_TEXT, [("isotropic", "isotropic"), ("kinematic", "kinematic")],
        ),
        ("Shear of steel 4340", SHEAR, (1, MPA), ("strain", "stress [MPa]"), [("slow", "1e-3/s"), ("fast", "1e4/s")]),
        ("Shock in steel 4340", PRESSURE, (1, MPA), PRESSURE_TEXT, [("shock", "")]),
    ],
    "clay_brick": [
        (
            "Uniaxial stress", AXIAL, (MILLI, MPA), AXIAL_TEXT,
            [("compression", "free"), ("tension", "tension"), ("confined", "5 MPa")],
        ),
    ],
    "rock_masses": [
        (
            "Hoek and Brown, GSI 45", AXIAL, (MILLI, MPA), AXIAL_TEXT,
            [("mass_0", "free"), ("mass_5", "5 MPa"), ("mass_10", "10 MPa")],
        ),
        ("From GSI 75 to 30", AXIAL, (MILLI, MPA), AXIAL_TEXT, [("softening", "")]),
        (
            "Weak planes, confined by 2 MPa", AXIAL, (MILLI, MPA), AXIAL_TEXT,
            [("steep_2", "dip 60 degrees"), ("flat_2", "dip 20 degrees")],
        ),
    ],
    "rubber": [
        ("Rubber", AXIAL, (1, MPA), ("strain", "stress [MPa]"), [("stretch", "sides free"), ("squeeze", "sides held")]),
    ],
}
plot.LIMITS = {("concrete_c40", 0): (-20, 0, -150, 0), ("concrete_c40", 2): (-20, 0, None, None)}
plot.__doc__ = __doc__

if __name__ == "__main__":
    if len(sys.argv) > 1 and sys.argv[1] not in plot.PANELS:
        sys.exit(f"{__doc__}\nDecks: {', '.join(plot.PANELS)}")
    plot.main()
