"""V33: pulses enter and leave through absorbing ends; rock in equilibrium between them stays at rest."""

import math

import numpy
from coplanetest import Case, waves

case = Case("V33", __file__)
density, modulus, poisson = 2650.0, 60e9, 0.25
shear_modulus = modulus / (2 * (1 + poisson))
p_modulus = modulus * (1 - poisson) / ((1 + poisson) * (1 - 2 * poisson))
speed = {"P": math.sqrt(p_modulus / density), "S": math.sqrt(shear_modulus / density)}
amplitude, length, waves_length = 0.1, 4.0, 2.0  # [m/s], [m], of the pulse [m]: 40 elements

for dimension in ("2d", "3d"):
    for wave in ("P", "S"):
        for split in (None, "triangles") if dimension == "2d" else (None, "tetrahedra"):
            axis = 0 if wave == "P" else 1
            c = speed[wave]
            duration = waves_length / c
            incident = [0, 0, 0]
            incident[axis] = waves.bump(amplitude, duration)
            recipe, deck = case.load(f"mesh_{dimension}.yaml"), case.load()
            if split:
                recipe["parts"][0]["split"] = split
            held = [axis_ for axis_ in "xyz"[: int(dimension[0])] if axis_ != "xyz"[axis]]
            deck["conditions"] = [
                {"type": "fixed", "node_set": "all", "components": held},
                {"type": "absorbing", "side_set": "start", "incident": incident},
                {"type": "absorbing", "side_set": "end"},
            ]
            # Until the pulse has left, and what the end sends back has passed the middle.
            deck["time"] = {"end": (2.2 * length + waves_length) / c, "step_factor": 0.7}
            deck["output"] = {"every": deck["time"]["end"] / 2, "planes": False}
            name = f"{dimension}_{wave}" + (f"_{split}" if split else "")
            run = case.run(name, recipe, deck)
            h = run.history
            middle, time = h[f"middle_velocity_{'xyz'[axis]}"], h["time"]
            case.check(f"{name}: peak in the middle [m/s]", waves.peak(middle), amplitude, 0.01, relative=True)
            arrival = 0.5 * length / c + 0.5 * duration
            case.check(f"{name}: time of the peak [s]", time[numpy.argmax(middle)], arrival, 0.01, relative=True)
            passed = time > 0.5 * length / c + 1.05 * duration
            case.check(
                f"{name}: what comes back, over what went in", numpy.max(numpy.abs(middle[passed])) / amplitude, 0, 0.01
            )
            # rho c v^2 enters through the area; the mean of the squared bump is 3/8.
            area = 0.1 ** (int(dimension[0]) - 1)
            entered = density * c * area * amplitude**2 * duration * 3 / 8
            case.check(f"{name}: energy that enters [J]", numpy.max(h["external_work"]), entered, 0.01, relative=True)
            inside = h["kinetic"][-1] + h["internal"][-1] + h["hourglass"][-1]
            case.check(f"{name}: energy that stays, over what entered", inside / entered, 0, 1e-4)

rest = case.run("rest", case.load("mesh_rest.yaml"), case.load("deck_rest.yaml"))
case.check("rest: largest speed [m/s]", numpy.max(numpy.abs(rest.results.nodal("velocity"))), 0, 1e-9)
case.check("rest: most kinetic energy [J]", numpy.max(rest.history["kinetic"]), 0, 0.5 * rest.mass * 1e-18)
case.check_equal("rest: planes that opened", int(numpy.max(rest.history["open"])), 0)
case.finish()
