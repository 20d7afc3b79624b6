"""Waves in strips: what is measured on records of probes, and exact answers for joints.

A record is a pair (times, velocity) with constant steps, from rest to rest.
"""

import numpy


def spectrum(times, values, frequency):
    """Fourier integral of a record at one frequency [Hz]: sum of v exp(-i w t) dt."""
    return numpy.sum(values * numpy.exp(-2j * numpy.pi * frequency * times)) * (times[1] - times[0])


def ratio(times, values, reference, frequency):
    """Complex amplitude of one record over that of another at one frequency."""
    return spectrum(times, values, frequency) / spectrum(times, reference, frequency)


def lag(ratio):
    """By which the first record is behind the second [degrees]."""
    return -numpy.degrees(numpy.angle(ratio))


def phase(times, values, reference, frequencies):
    """Of one record behind another, unwrapped along frequencies that start near zero [rad]."""
    ratios = numpy.array([ratio(times, values, reference, f) for f in frequencies])
    return -numpy.unwrap(numpy.angle(ratios))


def peak(values):
    """Largest value between samples: top of the parabola through the largest sample and its neighbours."""
    top = int(numpy.argmax(values))
    a, b, c = values[top - 1 : top + 2]
    bend = a - 2 * b + c
    return b if bend == 0 else b - (c - a) ** 2 / (8 * bend)


def energy(times, values):
    """Integral of the square of a record."""
    return numpy.sum(values**2) * (times[1] - times[0])


def tone_burst(amplitude, frequency, cycles):
    """Deck expression of a sine under a Hann window that starts and ends at zero."""
    end = cycles / frequency
    return (
        f"t < {end!r} ? {amplitude!r} * sin(2*_pi*{frequency!r}*t) * (0.5 - 0.5*cos(2*_pi*t/{end!r})) : 0"
    )


def bump(amplitude, duration):
    """Deck expression of one smooth hump; its spectrum reaches from zero to 2 / duration."""
    return f"t < {duration!r} ? {amplitude!r} * (0.5 - 0.5*cos(2*_pi*t/{duration!r})) : 0"


def half_sine(amplitude, frequency):
    """Deck expression of half a period of a sine."""
    return f"t < {0.5 / frequency!r} ? {amplitude!r} * sin(2*_pi*{frequency!r}*t) : 0"


def ramp(amplitude, rise):
    """Deck expression of a smooth step."""
    return f"t < {rise!r} ? {amplitude!r} * (0.5 - 0.5*cos(_pi*t/{rise!r})) : {amplitude!r}"


def joints(frequency, number, stiffness, impedance, speed, spacing=1.0):
    """Transmission through equal joints in a row, by transfer matrices: the complex ratio of the velocity
    behind the last joint to that of the incident wave at the same place without joints.

    A joint passes the stress on and opens by stress / stiffness (displacement discontinuity), so with
    the state (velocity v, stress s) of harmonic waves exp(i w t): v+ = v- + i w s / k. Between joints the
    wave s = -Z v to the right, s = +Z v to the left.
    """
    w = 2 * numpy.pi * numpy.atleast_1d(frequency)
    flat = numpy.ones_like(w)
    joint = numpy.array([[flat, 1j * w / stiffness], [0 * flat, flat]]).transpose(2, 0, 1)
    a = w * spacing / speed
    rock = numpy.array(
        [[numpy.cos(a), 1j * numpy.sin(a) / impedance], [1j * numpy.sin(a) * impedance, numpy.cos(a)]]
    ).transpose(2, 0, 1)
    total = joint
    for _ in range(number - 1):
        total = joint @ rock @ total
    # Behind: (1, -Z) t. In front, through the inverse (the determinant is 1): (1, -Z) + r (1, Z).
    velocity = total[:, 1, 1] + total[:, 0, 1] * impedance
    stress = -total[:, 1, 0] - total[:, 0, 0] * impedance
    incident = (velocity - stress / impedance) / 2
    return 1 / incident * numpy.exp(1j * a * (number - 1))


def passed(times, values, transfer):
    """A record after a linear system: `transfer` gives the complex ratio for an array of frequencies. What
    rings longer than the record would come back at its start; a decaying exponential, taken as an
    imaginary part of the frequency, keeps that below 1e-8.
    """
    dt, number = times[1] - times[0], len(times)
    decay = 20 / (number * dt)
    weight = numpy.exp(-decay * dt * numpy.arange(number))
    frequencies = numpy.fft.fftfreq(number, dt) - 1j * decay / (2 * numpy.pi)
    return numpy.fft.ifft(numpy.fft.fft(values * weight) * transfer(frequencies)).real / weight


def row_of_blocks(frequency, places, blocks, stiffness, impedance, speed, spacing=1.0):
    """Velocity at some places in a row of blocks with equal joints between them, over the velocity that its left end is given, for
    harmonic waves exp(i w t). The right end absorbs. By the transfer matrices of joints(), from the right end to the left: waves
    that fade grow that way, so nothing cancels. Places lie inside blocks [m].
    """
    w = 2 * numpy.pi * numpy.atleast_1d(frequency)
    flat = numpy.ones_like(w)

    def back(state, length):
        a = w * length / speed
        velocity, stress = state
        return (velocity * numpy.cos(a) - 1j * stress * numpy.sin(a) / impedance,
                -1j * velocity * numpy.sin(a) * impedance + stress * numpy.cos(a))

    state, here, found = (flat, -impedance * flat), blocks * spacing, {}  # s = -Z v at the right end
    for block in range(blocks - 1, -1, -1):
        for place in sorted((p for p in places if block * spacing <= p < (block + 1) * spacing), reverse=True):
            state, here = back(state, here - place), place
            found[place] = state[0]
        state, here = back(state, here - block * spacing), block * spacing
        if block > 0:
            state = (state[0] - 1j * w / stiffness * state[1], state[1])
    return [found[place] / state[0] for place in places]
