"""A rigid block that rocks on its corners after G. W. Housner (1963): the equation of motion with impacts, integrated."""

import math

import numpy


def rocking(acceleration, end, alpha, rate, gravity=9.81, restitution=None, step=1e-4):
    """Times [s] and clockwise tilts [rad] of a block on a floor with this acceleration (a function of time) [m/s^2], by the fourth
    order method of Runge and Kutta.

    alpha: angle of the diagonal to the vertical [rad]. rate: p of Housner, p^2 = 3 g / (4 R) for a rectangle whose half diagonal is R
    [1/s]. It ends with the first impact, or goes on with `restitution` times the spin; beyond a tilt of a right angle it ends.
    """

    def spin_up(t, turn, side):
        return -(rate**2) * (math.sin(side * alpha - turn) + acceleration(t) / gravity * math.cos(side * alpha - turn))

    times, turns = [0.0], [0.0]
    t, turn, spin, side = 0.0, 0.0, 0.0, 0
    while t < end:
        if side == 0:  # it stands
            if abs(acceleration(t)) > gravity * math.tan(alpha):
                side = -1 if acceleration(t) > 0 else 1
            else:
                t += step
                times.append(t), turns.append(0.0)
                continue
        k = []
        for part in (0, 0.5, 0.5, 1):
            slope = k[-1] if k else (0.0, 0.0)
            k.append((spin + part * step * slope[1], spin_up(t + part * step, turn + part * step * slope[0], side)))
        turn += step * (k[0][0] + 2 * k[1][0] + 2 * k[2][0] + k[3][0]) / 6
        spin += step * (k[0][1] + 2 * k[1][1] + 2 * k[2][1] + k[3][1]) / 6
        t += step
        times.append(t), turns.append(turn)
        if abs(turn) > math.pi / 2:
            break
        if turn * side < 0:
            if restitution is None:
                break
            turn, spin, side = 0.0, restitution * spin, -side
            if abs(spin) < 1e-3 * rate * alpha:
                spin, side = 0.0, 0
    return numpy.array(times), numpy.array(turns)
