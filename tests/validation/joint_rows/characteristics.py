"""Plane waves across a row of equal joints that close along a hyperbola, by the method of characteristics."""

import numpy


def closing(stiffness, most, elastic):
    """Normal stress of a joint as a function of its closure [Pa], with the memory of the largest one: k c / (1 - c / most).

    elastic: unloads on the same curve (Zhao and Cai); else along its tangent at the largest closure, as the law closure_curve. No tension.
    """
    largest = 0.0

    def stress(closure):
        nonlocal largest
        if closure <= 0:
            return 0.0
        if elastic or closure >= largest:
            largest = max(largest, closure)
            return stiffness * closure / (1 - closure / most)
        top = stiffness * largest / (1 - largest / most)
        return max(0.0, top - stiffness / (1 - largest / most) ** 2 * (largest - closure))

    return stress


def behind(incident, step, number, delay, impedance, law):
    """Velocity of the wave behind the last joint [m/s] at all steps. incident: velocity of the wave that arrives at the first joint, at each step of
    `step` seconds; delay: from joint to joint, in steps; law(): a fresh function as `closing` returns. A joint passes the stress S on; with the wave p
    that comes from the left and q from the right, velocities v- = 2 p - S/z and v+ = 2 q + S/z (compression to the right positive), closure' = v- - v+.
    """
    laws = [law() for _ in range(number)]
    closures = numpy.zeros(number)
    right = numpy.zeros((number + 1, len(incident)))  # right[i]: arrives at joint i from the left
    left = numpy.zeros((number + 1, len(incident)))  # left[i]: arrives at joint i - 1 from the right
    right[0] = incident
    stresses = numpy.zeros(number)
    for t in range(len(incident) - 1):
        for i in range(number):
            p, q = right[i, t], left[i + 1, t]
            # Heun: the stress at the end from a first guess, then the mean of both rates.
            rate = 2 * (p - q) - 2 * stresses[i] / impedance
            p1, q1 = right[i, t + 1] if i == 0 else p, q
            guess = laws[i](closures[i] + step * rate)
            rate = 0.5 * (rate + 2 * (p1 - q1) - 2 * guess / impedance)
            closures[i] += step * rate
            stresses[i] = laws[i](closures[i])
            passed, back = q1 + stresses[i] / impedance, p1 - stresses[i] / impedance
            at = t + 1 if i == number - 1 else t + 1 + delay
            if at < len(incident):
                right[i + 1, at] = passed
            if i > 0 and t + 1 + delay < len(incident):
                left[i, t + 1 + delay] = back
    return right[number]
