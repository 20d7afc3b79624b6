"""V73: a plane detonation in TNT that starts at a wall: Chapman and Jouguet's state and Taylor's wave."""

import numpy
from coplanetest import Case

case = Case("V73", __file__)

density, a, b, r1, r2, omega, energy = 1630, 371.2e9, 3.231e9, 4.15, 0.95, 0.3, 7e9
speed, time = 6930, 12e-6

# --- The state behind the front: where the line of Rayleigh touches the curve of Hugoniot, by its least slope.
volumes = numpy.linspace(0.6, 0.9, 300001)


def first(v):
    return a * numpy.exp(-r1 * v)


def second(v):
    return b * numpy.exp(-r2 * v)


hugoniot = first(volumes) * (1 - omega / (r1 * volumes)) + second(volumes) * (1 - omega / (r2 * volumes)) + omega * energy / volumes
hugoniot /= 1 - omega * (1 - volumes) / (2 * volumes)
at = numpy.argmin(hugoniot / (1 - volumes))
volume_cj, pressure_cj = volumes[at], hugoniot[at]
speed_cj = numpy.sqrt(pressure_cj / (1 - volume_cj) / density)
case.check("speed of the front of the card [m/s]", speed, speed_cj, 1e-3, relative=True)

# --- Taylor's wave: the isentrope through that state; x/t = u + c, u from the speed behind the front down to 0 at the wall.
constant = (pressure_cj - first(volume_cj) - second(volume_cj)) * volume_cj ** (1 + omega)
v = numpy.linspace(volume_cj, 1.5, 200001)
p = first(v) + second(v) + constant * v ** (-1 - omega)
c = v * numpy.sqrt((r1 * first(v) + r2 * second(v) + (1 + omega) * constant * v ** (-2 - omega)) / density)
slope = c / v
u = (1 - volume_cj) * speed_cj - numpy.concatenate([[0], numpy.cumsum(0.5 * (slope[1:] + slope[:-1]) * numpy.diff(v))])
wave = u >= 0
reach, p, u = (u + c)[wave], p[wave], u[wave]
rest, pressure_rest = reach[-1], p[-1]


def exact(x):
    """Pressure and speed at present places x behind the front."""
    xi = numpy.clip(x / time, rest, reach[0])
    return numpy.interp(-xi, -reach, p), numpy.interp(-xi, -reach, u)


def state(run, step):
    r = run.results
    moved = r.nodal("displacement", step)[:, 0] + r.coordinates[:, 0]
    corners = r.connectivity("charge")
    order = numpy.argsort(moved[corners].mean(axis=1))
    return (
        moved[corners].mean(axis=1)[order],
        r.element("charge", "pressure", step)[order],
        r.nodal("velocity", step)[:, 0][corners].mean(axis=1)[order],
        r.element("charge", "burn_fraction", step)[order],
    )


def front(x, burnt):
    i = numpy.nonzero(burnt > 0.5)[0][-1]
    return numpy.interp(-0.5, -burnt[i : i + 2], x[i : i + 2])


errors, peaks = {}, {}
for count in (200, 400):
    mesh, deck = case.load("mesh.yaml"), case.load("deck.yaml")
    size = 0.1 / count
    mesh["parts"][0].update(size=[0.1, size], divisions=[count, 1])
    deck["materials"]["charge"]["lighting_points"] = [[0, size / 2]]
    run = case.run(str(count), mesh, deck, energy=1e-4)
    places = []
    for step in (1, 2):
        x, pressure, velocity, burnt = state(run, step)
        places.append(front(x, burnt))
    case.check(f"{count}: speed of the front [m/s]", (places[1] - places[0]) / 6e-6, speed_cj, 0.005, relative=True)
    still = (x > 0.15 * rest * time) & (x < 0.9 * rest * time)
    case.check(f"{count}: pressure at rest behind the wave [Pa]", pressure[still].mean(), pressure_rest, 0.02, relative=True)
    fan = (x > rest * time) & (x < places[1] - 0.004)
    at_fan, moving = exact(x[fan])
    case.check(f"{count}: pressure in the wave, largest error over p_CJ", abs(pressure[fan] - at_fan).max() / pressure_cj, 0, 0.02)
    case.check(f"{count}: speed in the wave, largest error over u_CJ", abs(velocity[fan] - moving).max() / u[0], 0, 0.02)
    errors[count] = abs(pressure[fan] - at_fan).mean() / pressure_cj
    peaks[count] = pressure.max()
    # What has burnt lies behind the front: the same mass, whatever its density is now.
    case.check(f"{count}: released energy [J]", run.history["chemical"][-1], energy * size * places[1], 2e-3, relative=True)
    if count == 200:
        case.same_bits("200", mesh, deck, run)
case.check_within("mean error of the pressure: 200 over 400 elements", errors[200] / errors[400], 1.4, 4)
case.check("largest pressure, 400 elements [Pa]", peaks[400], pressure_cj, 0.02, relative=True)
case.check("largest pressure, extrapolated to no size [Pa]", 2 * peaks[400] - peaks[200], pressure_cj, 0.01, relative=True)
case.finish()
