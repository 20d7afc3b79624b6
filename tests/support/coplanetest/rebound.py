"""A mass that bounces off a spring and a dashpot beside it."""

import math


def restitution(zeta):
    """Speed after over speed before, of a rigid mass on a spring k and a dashpot 2 zeta sqrt(k m) that push but never pull.

    In units of 1/frequency, with w^2 = 1 - zeta^2: x = exp(-zeta t) sin(w t) / w. The force vanishes, and the mass leaves, when
    tan(w t) = -2 zeta w / (1 - 2 zeta^2); its speed is then exp(-zeta t). (A dashpot that may pull until the closure is zero would
    give exp(-pi zeta / w).)
    """
    w = math.sqrt(1 - zeta**2)
    return math.exp(-zeta / w * (math.pi - math.atan2(2 * zeta * w, 1 - 2 * zeta**2)))
